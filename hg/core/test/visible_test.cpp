#include "hg/core/visible.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace hg {
namespace {

using namespace std::string_view_literals;

TEST(Visible, KeepsText) {
  for (const std::string_view text :
       {""sv, "line\n\tof text ~"sv, "Gr\u00F6\u00DFe \u20AC \u00A0 1.5\u00B0 \U0001F600"sv,
        "\u07FF\u0800\uFFFD\U00010000\U0010FFFF"sv}) {
    EXPECT_EQ(visible(text), text);
  }
}

TEST(Visible, EscapesControlCharacters) {
  EXPECT_EQ(visible("\x1b[31m\r\x7f\0."sv), "\\x1b[31m\\x0d\\x7f\\x00.");
  EXPECT_EQ(visible("\u009b2J\u0080"), "\\xc2\\x9b2J\\xc2\\x80");
}

TEST(Visible, EscapesWhatIsNotTheShortestUtf8) {
  EXPECT_EQ(visible("\x9b"), "\\x9b");
  EXPECT_EQ(visible("\xc0\x9b\xc1\xbf"), "\\xc0\\x9b\\xc1\\xbf");
  EXPECT_EQ(visible("\xe0\x80\x9b"), "\\xe0\\x80\\x9b");
  EXPECT_EQ(visible("\xe0\x9f\xbf"), "\\xe0\\x9f\\xbf");
  EXPECT_EQ(visible("\xf0\x80\x80\x9b"), "\\xf0\\x80\\x80\\x9b");
  EXPECT_EQ(visible("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // surrogate
  EXPECT_EQ(visible("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // behind the last character
  EXPECT_EQ(visible("\xe2\x82"), "\\xe2\\x82");                    // cut off
  EXPECT_EQ(visible("\xfe\xff"), "\\xfe\\xff");
}

TEST(Utf8, IsValidWithControlCharactersAndNotOtherwise) {
  for (const std::string_view text : {""sv, "T\u00FCr"sv, "\x1b\x7f\0"sv, "\u202E\u009b"sv}) {
    EXPECT_TRUE(is_utf8(text)) << visible(text);
  }
  for (const std::string_view text :
       {"T\xfcr"sv, "\x9b"sv, "\xc0\x9b"sv, "\xed\xa0\x80"sv, "\xe2\x82"sv}) {
    EXPECT_FALSE(is_utf8(text)) << visible(text);
  }
}

TEST(Visible, EscapesWhatTurnsTheDirectionOrIsNotSeen) {
  EXPECT_EQ(visible("a\u202Eb"), "a\\xe2\\x80\\xaeb");
  for (const std::string_view text :
       {"\u061C"sv, "\u200E"sv, "\u200F"sv, "\u2028"sv, "\u2029"sv, "\u202A"sv, "\u2066"sv,
        "\u2069"sv, "\uFEFF"sv, "\U000E0041"sv}) {
    EXPECT_EQ(shown_bytes(text), 0U) << visible(text);
  }
}

}  // namespace
}  // namespace hg
