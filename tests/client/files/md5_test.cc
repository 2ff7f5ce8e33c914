// Digests of plates: client/files/md5.

#include "client/files/md5.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

namespace traverse {
namespace {

TEST(Md5, IsThatOfItsStandard) {
  EXPECT_EQ(Md5Hex("message digest"), "F96B697D7CB7938D525A2F31AAF161D0");
}

TEST(Md5, IsWrittenAsTheOneBefore) {
  const std::string digest = "F96B697D7CB7938D525A2F31AAF161D0";

  EXPECT_EQ(WithMd5("3deb4d98d9e0dd55959de96bbc65d76f", digest),
            "f96b697d7cb7938d525a2f31aaf161d0");
  EXPECT_EQ(WithMd5("3DEB4D98D9E0DD55959DE96BBC65D76F\r\n", digest), digest + "\r\n");
  EXPECT_EQ(FindMd5("3deb4d98d9e0dd55959de96bbc65d76f\n"), "3DEB4D98D9E0DD55959DE96BBC65D76F");
  EXPECT_EQ(FindMd5("3deb4d98d9e0dd55959de96bbc65d76"), std::nullopt);
  EXPECT_EQ(FindMd5("3deb4d98d9e0dd55959de96bbc65d76f0"), std::nullopt);
}

}  // namespace
}  // namespace traverse
