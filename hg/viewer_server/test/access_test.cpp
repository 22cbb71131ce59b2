#include "hg/viewer_server/access.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <set>

#include "hg/core/error.h"
#include "hg/core/test/temporary_folder.h"

namespace hg::viewer_server {
namespace {

TEST(RandomToken, HasThirtyTwoHexadecimalDigitsAndNeverRepeats) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) {
    const std::string token = random_token();
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    tokens.insert(token);
  }
  EXPECT_EQ(tokens.size(), 100u);
}

TEST(KeptToken, IsMadeOnceAndStaysItsOwnersOnly) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "token";
  const std::string token = kept_token(file);
  EXPECT_EQ(token.size(), 32u);
  EXPECT_EQ(kept_token(file), token);
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(file).permissions(), perms::owner_read | perms::owner_write);
  std::filesystem::permissions(file, perms::group_read, std::filesystem::perm_options::add);
  EXPECT_THROW(kept_token(file), SetupError);
}

TEST(KeptToken, IsNotTakenFromAnotherUser) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "token";
  kept_token(file);
  if (geteuid() != 0 || chown(file.c_str(), 1, 1) != 0)
    GTEST_SKIP() << "only root gives files away";
  EXPECT_THROW(kept_token(file), SetupError);
}

TEST(KeptToken, LeavesNoFileWhereItCannotBeWritten) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "token";
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto signal_before = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit few_bytes = {.rlim_cur = 8, .rlim_max = before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &few_bytes), 0);
  std::string said;
  try {
    kept_token(file);
  } catch (const SetupError& error) {
    said = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, signal_before);
  EXPECT_NE(said.find("cannot be written"), std::string::npos) << said;
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_EQ(kept_token(file).size(), 32u);
}

TEST(KeptToken, RefusesFilesThatHoldNone) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "token";
  for (const char* text : {"", "abc", "0123456789abcdef0123456789abcdeg",
                           "0123456789abcdef0123456789abcdef0123456789abcdef"}) {
    std::ofstream(file) << text;
    std::filesystem::permissions(
        file, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    EXPECT_THROW(kept_token(file), SetupError) << text;
  }
  std::ofstream(file) << "0123456789abcdef0123456789abcdef\n";
  EXPECT_EQ(kept_token(file), "0123456789abcdef0123456789abcdef");
  EXPECT_THROW(kept_token(folder.path() / "missing" / "token"), SetupError);
}

TEST(IsSameSecret, AgreesWithEquality) {
  rc::check([](const std::string& a, const std::string& b) {
    RC_ASSERT(is_same_secret(a, a));
    RC_ASSERT(is_same_secret(a, b) == (a == b));
  });
  EXPECT_FALSE(is_same_secret("abc", "abd"));
  EXPECT_FALSE(is_same_secret("abc", "ab"));
}

const Listener kLocal = {"127.0.0.1", 8080};

TEST(IsOwnHost, AcceptsThisMachineWithThisPortOnly) {
  EXPECT_TRUE(is_own_host("127.0.0.1:8080", kLocal));
  EXPECT_TRUE(is_own_host("localhost:8080", kLocal));
  for (const char* host :
       {"", "127.0.0.1", "127.0.0.1:8081", "evil.example:8080", "localhost:8080.evil.example",
        "localhost.evil.example:8080", "192.0.2.7:8080", "[::1]:8080"}) {
    EXPECT_FALSE(is_own_host(host, kLocal)) << host;
  }
}

TEST(IsOwnHost, AcceptsTheAddressThatIsListenedAt) {
  EXPECT_TRUE(is_own_host("192.0.2.7:8080", {"192.0.2.7", 8080}));
  EXPECT_FALSE(is_own_host("192.0.2.8:8080", {"192.0.2.7", 8080}));
  EXPECT_TRUE(is_own_host("[::1]:8080", {"::1", 8080}));
}

TEST(IsOwnHost, AcceptsAnyAddressButNoNameWhereAllAreListenedAt) {
  for (const char* address : {"0.0.0.0", "::"}) {
    const Listener all = {address, 8080};
    EXPECT_TRUE(is_own_host("192.0.2.7:8080", all));
    EXPECT_TRUE(is_own_host("[2001:db8::7]:8080", all));
    for (const char* host : {"evil.example:8080", "192.0.2.7.evil.example:8080", "192.0.2.7",
                             "192.0.2.7:81", "::1:8080", "[192.0.2.7]:8080", "[]:8080", ":8080"}) {
      EXPECT_FALSE(is_own_host(host, all)) << host;
    }
  }
}

TEST(IsOwnOrigin, AcceptsPlainHttpOfThisServerOnly) {
  EXPECT_TRUE(is_own_origin("http://127.0.0.1:8080", kLocal));
  EXPECT_TRUE(is_own_origin("http://localhost:8080", kLocal));
  for (const char* origin : {"", "null", "https://127.0.0.1:8080", "http://evil.example",
                             "http://127.0.0.1:8080.evil.example", "http://127.0.0.1:9"}) {
    EXPECT_FALSE(is_own_origin(origin, kLocal)) << origin;
  }
}

TEST(IsWebOrigin, IsSchemeHostAndPortOnly) {
  for (const std::string origin : {"http://127.0.0.1:8123", "https://study.example",
                                   "http://[::1]:80", "http://localhost:8123"}) {
    EXPECT_TRUE(is_web_origin(origin)) << origin;
  }
  for (const std::string text :
       {"", "*", "'self'", "127.0.0.1:8123", "http://", "http://*:8123", "http://127.0.0.1:8123/",
        "http://a b", "http://a;b", "http://a\r\nX: y", "ftp://a", "http://a:", "http://a:123456",
        "http://a http://b"}) {
    EXPECT_FALSE(is_web_origin(text)) << text;
  }
}

TEST(ContentPolicy, NamesThoseThatMayShowThePage) {
  EXPECT_TRUE(content_policy({}).ends_with("; frame-ancestors 'none'"));
  EXPECT_TRUE(content_policy({"http://a:1", "http://b:2"})
                  .ends_with("; frame-ancestors http://a:1 http://b:2"));
}

TEST(Access, FindsTheTokenInAQuery) {
  EXPECT_EQ(query_token("/live?token=abc"), "abc");
  EXPECT_EQ(query_token("/live?x=1&token=abc&y=2"), "abc");
  for (const char* other :
       {"", "/", "/live", "?", "/live?", "/live?xtoken=abc", "/live?token", "token=abc"}) {
    EXPECT_EQ(query_token(other), "") << other;
  }
}

TEST(Token, IsFoundInTheHeadersOfRequestAndWebSocket) {
  EXPECT_EQ(path_of("/a/b?token=1"), "/a/b");
  EXPECT_EQ(bearer_token("Bearer abc"), "abc");
  EXPECT_EQ(bearer_token("bearer abc"), "");
  EXPECT_EQ(bearer_token("Basic abc"), "");
  EXPECT_EQ(bearer_token("Bearer"), "");
  EXPECT_EQ(protocol_token("hapticgiant, token.abc"), "abc");
  EXPECT_EQ(protocol_token("hapticgiant,token.abc"), "abc");
  for (const char* other : {"", "hapticgiant", "token.abc", "hapticgiant, abc", "other, token.abc",
                            "token.abc, hapticgiant"}) {
    EXPECT_EQ(protocol_token(other), "") << other;
  }
}

TEST(Token, IsPartOfAnyInput) {
  rc::check([](const std::string& text) {
    RC_ASSERT(bearer_token(text).size() <= text.size());
    RC_ASSERT(protocol_token(text).size() <= text.size());
    RC_ASSERT(query_token(text).size() <= text.size());
  });
}

TEST(LoadPage, WithoutIndexExplainsHowToBuildIt) {
  try {
    load_page("hg/viewer_server");
    FAIL() << "no SetupError";
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find("npm run build"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace hg::viewer_server
