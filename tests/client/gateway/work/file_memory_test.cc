#include "client/gateway/work/file_memory.h"

#include <gtest/gtest.h>
#include <lzma.h>

#include <memory>
#include <string>

#include "client/gateway/spool/spool.h"

namespace traverse::gateway {
namespace {

// A few bytes with the dictionary of `xz -9`.
std::string PackedWithALargeDictionary() {
  const std::string text = "G1 X1 E1\n";
  std::string packed(lzma_stream_buffer_bound(text.size()), '\0');
  size_t size = 0;
  EXPECT_EQ(lzma_easy_buffer_encode(
                9, LZMA_CHECK_CRC32, nullptr, reinterpret_cast<const uint8_t*>(text.data()),
                text.size(), reinterpret_cast<uint8_t*>(packed.data()), &size, packed.size()),
            LZMA_OK);
  packed.resize(size);
  return packed;
}

TEST(MemoryToMeasure, CountsTheDictionaryOfWhatIsUnpacked) {
  const auto spool = *Spool::Open(::testing::TempDir(), 1 << 20);
  const std::shared_ptr<SpoolFile> plain = *spool->NewFile("a");
  const std::shared_ptr<SpoolFile> packed = *spool->NewFile("a");
  ASSERT_TRUE(plain->Append("G1 X1 E1\n").ok());
  ASSERT_TRUE(packed->Append(PackedWithALargeDictionary()).ok());

  EXPECT_GE(MemoryToMeasure(*packed), MemoryToMeasure(*plain) + (int64_t{64} << 20));
}

}  // namespace
}  // namespace traverse::gateway
