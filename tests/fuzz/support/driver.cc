// Runs a fuzz target without libFuzzer: what makes it a test of the suite.
//
//   fuzz_NAME [--runs=N] [--seed=S] [--verbose] [FILE or FOLDER]...
//
// First every file given, then N inputs made at random from these, the same ones for the same seed.
// --verbose prints the number of each input before it is run: the last one printed is at fault.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" {
int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned int seed)
    __attribute__((weak));
}

namespace {

using Bytes = std::vector<uint8_t>;

constexpr size_t kMaxBytes = 1 << 16;

// An input is given up for a fresh one after so many changes on top of each other.
constexpr unsigned kChangesInARow = 20;

Bytes ReadBytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(file), {});
}

// Changes, inserts, removes or repeats some bytes.
void ChangeBytes(Bytes& bytes, std::mt19937& random) {
  const auto below = [&random](size_t n) {
    return std::uniform_int_distribution<size_t>(0, n - 1)(random);
  };
  const size_t kind = bytes.empty() ? 1 : below(4);
  const size_t at = below(bytes.size() + 1);
  const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  const auto length = static_cast<std::ptrdiff_t>(std::min(below(16) + 1, bytes.size() - at));
  if (kind == 0 && at < bytes.size()) {
    bytes[at] = static_cast<uint8_t>(random());
  } else if (kind == 1 && bytes.size() < kMaxBytes) {
    bytes.insert(place, static_cast<uint8_t>(random()));
  } else if (kind == 2) {
    bytes.erase(place, place + length);
  } else if (bytes.size() + 16 < kMaxBytes) {
    const Bytes copy(place, place + length);
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(below(bytes.size() + 1)), copy.begin(),
                 copy.end());
  }
}

void Mutate(Bytes& bytes, std::mt19937& random) {
  if (LLVMFuzzerCustomMutator == nullptr) return ChangeBytes(bytes, random);
  const size_t size = bytes.size();
  bytes.resize(kMaxBytes);
  bytes.resize(
      LLVMFuzzerCustomMutator(bytes.data(), size, kMaxBytes, static_cast<unsigned int>(random())));
}

struct Arguments {
  uint64_t runs = 0;
  uint32_t seed = 1;
  bool verbose = false;
  std::vector<Bytes> inputs;
};

Arguments Parse(int argc, char** argv) {
  namespace fs = std::filesystem;
  Arguments out;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.rfind("--runs=", 0) == 0) {
      out.runs = std::strtoull(argv[i] + std::strlen("--runs="), nullptr, 10);
    } else if (argument.rfind("--seed=", 0) == 0) {
      out.seed = static_cast<uint32_t>(std::strtoul(argv[i] + std::strlen("--seed="), nullptr, 10));
    } else if (argument == "--verbose") {
      out.verbose = true;
    } else if (fs::is_directory(argument)) {
      std::vector<fs::path> files{fs::directory_iterator(argument), fs::directory_iterator()};
      std::sort(files.begin(), files.end());
      for (const fs::path& file : files) out.inputs.push_back(ReadBytes(file));
    } else if (fs::exists(argument)) {
      out.inputs.push_back(ReadBytes(argument));
    } else {
      std::fprintf(stderr, "%s: no such file or flag: %s\n", argv[0], argv[i]);
      std::exit(2);
    }
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments = Parse(argc, argv);
  for (size_t i = 0; i < arguments.inputs.size(); ++i) {
    if (arguments.verbose) std::fprintf(stderr, "file %zu\n", i);
    LLVMFuzzerTestOneInput(arguments.inputs[i].data(), arguments.inputs[i].size());
  }
  arguments.inputs.emplace_back();
  std::mt19937 random(arguments.seed);
  Bytes bytes;
  for (uint64_t run = 0; run < arguments.runs; ++run) {
    if (run % kChangesInARow == 0) bytes = arguments.inputs[random() % arguments.inputs.size()];
    Mutate(bytes, random);
    if (arguments.verbose) std::fprintf(stderr, "run %llu\n", static_cast<unsigned long long>(run));
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::printf("%zu files and %llu random inputs\n", arguments.inputs.size() - 1,
              static_cast<unsigned long long>(arguments.runs));
  return 0;
}
