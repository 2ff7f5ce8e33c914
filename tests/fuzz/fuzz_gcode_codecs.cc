// Bytes as heatshrink and as MeatPack, and as what these are made of.
//
// Rules: what is packed comes out again; what is no such data is refused, and no more memory is
// taken than a limit allows.

#include <string>
#include <string_view>

#include "client/containers/bgcode/heatshrink.h"
#include "client/containers/bgcode/meatpack.h"
#include "tests/fuzz/support/check.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace traverse;
  using namespace traverse::containers;  // NOLINT
  if (size < 3) return 0;
  const HeatshrinkWindow window = {data[0] % 2 == 0 ? 11 : 12, 4};
  const size_t announced = size_t{data[1]} * 64 + data[2];
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 3, size - 3);

  const auto unpacked = HeatshrinkDecompress(bytes, window, announced);
  if (unpacked.ok()) fuzz::Check(unpacked->size() == announced, "as many bytes as announced");
  const std::string shrunk = HeatshrinkCompress(bytes, window);
  const auto back = HeatshrinkDecompress(shrunk, window, bytes.size());
  fuzz::Check(back.ok() && *back == bytes, "heatshrink gives back what it got");

  std::string text;
  constexpr size_t kLimit = 4096;
  const bool read = MeatUnpack(bytes, kLimit, text).ok();
  fuzz::Check(!read || text.size() <= 2 * kLimit, "no more text than allowed");
  if (CanMeatPack(bytes)) {
    std::string packed;
    std::string again;
    MeatPack(bytes, packed);
    fuzz::Check(MeatUnpack(packed, size_t{1} << 24, again).ok(), "what is packed can be read");
    fuzz::Check(EqualToAPrinter(again, bytes), "MeatPack gives back what it got");
  }
  return 0;
}
