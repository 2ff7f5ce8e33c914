#include "client/gateway/http/own_host.h"

#include <gtest/gtest.h>
#include <unistd.h>

namespace traverse::gateway {
namespace {

TEST(OwnHost, IsWhatNoStrangerCanHaveLedHere) {
  for (const char* host :
       {"", "127.0.0.1", "127.0.0.1:8080", "192.168.1.7:80", "[::1]:8080", "[fe80::1]", "localhost",
        "LOCALHOST:8080", "gateway", "gateway:8080", "octopi.local", "a.b.LOCAL.:80", "gateway.lan",
        "gateway.home.arpa", "x.localhost", "gateway.c.internal:8080"}) {
    EXPECT_TRUE(IsOwnHost(host, {})) << host;
  }
  for (const char* host :
       {"evil.example", "evil.example:8080", "evil.example.", "127.0.0.1.evil.example",
        "localhost.evil.example", "evillocal.example", "1.2.3", "gateway.svc"}) {
    EXPECT_FALSE(IsOwnHost(host, {})) << host;
  }
}

TEST(OwnHost, IsAnyNameThatIsAllowed) {
  EXPECT_TRUE(IsOwnHost("farm.example:8080", {"other.example", "Farm.example"}));
  EXPECT_FALSE(IsOwnHost("not.farm.example", {"farm.example"}));
  EXPECT_TRUE(IsOwnHost("anything.example", {"*"}));
}

TEST(OwnHost, IsTheNameOfThisMachine) {
  char name[256] = {};
  ASSERT_EQ(gethostname(name, sizeof(name) - 1), 0);
  EXPECT_TRUE(IsOwnHost(name, {}));
}

}  // namespace
}  // namespace traverse::gateway
