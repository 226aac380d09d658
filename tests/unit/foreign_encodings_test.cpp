#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware/log/csv_code_pages.hpp"
#include "read_campaign.hpp"

// Encodings beside UTF-8. Each is recognised by its bytes, and texts of another encoding stay what they are.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using enum TextEncoding;

constexpr std::string_view kRussian =
    "\xC2\xF0\xE5\xEC\xFF, \xF1;\xC3\xEB\xF3\xE1\xE8\xED\xE0, \xEC\xEC;1,5\n";

std::string in_utf32(std::string_view ascii, bool has_mark, bool big_endian) {
  std::string out;
  const auto put = [&](unsigned c) {
    for (int k = 0; k < 4; ++k) out.push_back(static_cast<char>(c >> 8 * (big_endian ? 3 - k : k)));
  };
  if (has_mark) put(0xFEFF);
  for (const char c : ascii) put(static_cast<unsigned char>(c));
  return out;
}

TEST(ForeignEncodings, CyrillicWordsAreWindows1251) {
  ASSERT_EQ(encoding_of(kRussian), windows_1251);
  EXPECT_THAT(utf8_from(kRussian, windows_1251), HasSubstr("Время, с;Глубина, мм"));
  EXPECT_EQ(encoding_of("\xD1\xC8\xCB\xC0;1"), windows_1251);
  for (const auto* text : {"L\xE4nge;Kraft;1", "D\xE9placement;Pr\xE9\x63ision \xE0 1", "Winkel [\xB0];1",
                           "\xC4;1", "t_s;F\n\xFF\xFF\xFF\xFF", "F\xFChrungsgr\xF6\xDF\x65;1"})
    EXPECT_EQ(encoding_of(text), windows_1252) << text;
  // Small letters before capitals: KOI8-R. The words tell that it is not Windows-1252.
  const std::string koi = "\xF7\xD2\xC5\xCD\xD1;\xF3\xC9\xCC\xC1;1";
  EXPECT_EQ(encoding_of(koi), windows_1252);
  EXPECT_TRUE(has_words_beyond_ascii(utf8_from(koi, windows_1252)));
  EXPECT_FALSE(has_words_beyond_ascii("Größe, Länge in µm², Ø, à la"));
}

TEST(ForeignEncodings, MacRomanIsRecognisedBehindSmallLetters) {
  const std::string french = "Temps \x8E\x63oul\x8E (s);D\x8Eplacement (mm);1";
  ASSERT_EQ(encoding_of(french), mac_roman);
  EXPECT_THAT(utf8_from(french, mac_roman), HasSubstr("Temps écoulé (s);Déplacement (mm)"));
  for (const auto* text :
       {"\x8A\xED\xF8ka;1", "\x8E\xE1\x64\x61n\xE1;1", "l\x92\x65\x66\x66ort;1", "0\x96\x31 s;1"})
    EXPECT_EQ(encoding_of(text), windows_1252) << text;
}

TEST(ForeignEncodings, Utf32IsReadWithAndWithoutAMark) {
  std::string text = "t_s,force_N,foot_z_m\n";
  for (int i = 0; i < 80; ++i)
    text += fmt::format("{:.1f},{:.4f},{:.5f}\n", 0.1 * i, 10.0 + 0.05 * i * i, -4e-4 * i);
  for (const bool has_mark : {true, false})
    for (const bool big_endian : {true, false}) {
      const auto told = read_campaign("plant = \"intruder\"", in_utf32(text, has_mark, big_endian));
      ASSERT_TRUE(told.recording.usable()) << told.text;
      EXPECT_EQ(told.recording.rows(), 80U);
      EXPECT_NEAR(told.recording.channel("force_N")[10], 15.0, 1e-9);
      EXPECT_THAT(told.text, HasSubstr("UTF-32"));
    }
  std::string wide;
  for (const char c : text) wide += {c, '\0'};
  EXPECT_EQ(encoding_of(wide), utf16_le);
}

TEST(ForeignEncodings, AStatedEncodingIsUsed) {
  std::string text = "t_s;\xD1\xE8\xEB\xE0 (N);foot_z_m\n";
  for (int i = 0; i < 80; ++i)
    text += fmt::format("{:.1f};{:.4f};{:.5f}\n", 0.1 * i, 10.0 + 0.05 * i * i, -4e-4 * i);
  const auto told = read_campaign(
      "plant = \"intruder\"\n[format]\nencoding = \"windows-1251\"\n[columns]\nforce_N = "
      "{ column = \"Сила (N)\", unit = \"N\" }",
      text);
  ASSERT_TRUE(told.recording.usable()) << told.text;
  EXPECT_NEAR(told.recording.channel("force_N")[10], 15.0, 1e-9);
}

}  // namespace
}  // namespace sandhopper
