#include "firmware/word_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "firmware/operator_text.hpp"

// From the bytes of an operator to words, and back to lines of JSON.
namespace sandhopper {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<Word> words_of(const std::vector<std::string>& reads, bool end = false) {
  WordReader reader;
  std::vector<WordReader::Line> lines;
  for (const auto& bytes : reads) reader.read(bytes, lines);
  if (end) reader.end(lines);
  std::vector<Word> words;
  for (const auto& line : lines) words.push_back(line.word);
  return words;
}

TEST(WordReader, SpacesLineEndsAndCapitalsDoNotMatter) {
  for (const std::string line :
       {"stop\n", "stop\r\n", "stop \n", " \tstop\t\r\n", "STOP\n", "Stop\n", "\x01stop\x7f\n"})
    EXPECT_THAT(words_of({line}), ElementsAre(Word::stop)) << ::testing::PrintToString(line);
  EXPECT_THAT(words_of({std::string("stop\0\n", 6)}), ElementsAre(Word::stop)) << "NUL at the end";
  EXPECT_THAT(words_of({"arm\nRelease\r\ndisarm\nQUIT\n"}),
              ElementsAre(Word::arm, Word::release, Word::disarm, Word::quit));
}

TEST(WordReader, WhatNobodyKnowsIsUnknown) {
  for (const std::string line : {"st op\n", "stopp\n", "sto\n", "\xEF\xBB\xBFstop\n", "st\xC3\xB6p\n",
                                 "end_of_input\n", "signal\n", "unknown\n"})
    EXPECT_THAT(words_of({line}), ElementsAre(Word::unknown)) << line;
  EXPECT_THAT(words_of({std::string("st\0op\n", 6)}), ElementsAre(Word::unknown)) << "NUL inside";
}

TEST(WordReader, EmptyLinesAreNoWords) { EXPECT_THAT(words_of({"\n\r\n  \n\t\n"}, true), IsEmpty()); }

TEST(WordReader, AWordMayComeInPieces) {
  EXPECT_THAT(words_of({"st", "o", "p", "\narm", "\n"}), ElementsAre(Word::stop, Word::arm));
}

TEST(WordReader, ALastLineWithoutItsEndIsALine) {
  EXPECT_THAT(words_of({"arm\nsto"}), ElementsAre(Word::arm));
  EXPECT_THAT(words_of({"arm\nstop"}, true), ElementsAre(Word::arm, Word::stop));
}

TEST(WordReader, TwoOperatorsInOneLineAreAnUnknownWord) {
  EXPECT_THAT(words_of({"rele", "stop\n", "ase\n"}), ElementsAre(Word::unknown, Word::unknown));
}

TEST(WordReader, ALineTooLongIsOneUnknownWordAtOnceAndItsTailIsNoWord) {
  const std::string longest(WordReader::kLongestLine - 4, ' ');
  EXPECT_THAT(words_of({longest + "stop\n"}), ElementsAre(Word::stop)) << "1024 bytes";
  EXPECT_THAT(words_of({longest + " release\n"}), ElementsAre(Word::unknown)) << "longer";
  EXPECT_THAT(words_of({longest + "  ", "   ", "arm"}), ElementsAre(Word::unknown)) << "before its end";
  EXPECT_THAT(words_of({std::string(5000, 'x'), "\nrelease\n"}), ElementsAre(Word::unknown, Word::release));
}

TEST(OperatorText, ControlCharactersQuotesAndBrokenUtf8AreValidJson) {
  std::string hostile;
  for (int c = 0; c < 256; ++c) hostile += static_cast<char>(c);
  for (const auto& text : {hostile, std::string("a\tb\rc\"\\\n\x01\x1b[31m"), std::string("\xC3")}) {
    const auto json = nlohmann::json::parse(operator_text("error", text), nullptr, false);
    ASSERT_FALSE(json.is_discarded()) << operator_text("error", text);
  }
  const std::string plain = "tab\t, escape \x1b, quote \", back\\slash";
  EXPECT_EQ(nlohmann::json::parse(operator_text("error", plain)).at("error"), plain);
}

TEST(OperatorText, AnOverruledRequestIsAnsweredAsSuch) {
  const auto json = nlohmann::json::parse(operator_text(RequestRecord{.time_ns = 2000,
                                                                      .received_ns = 1000,
                                                                      .number = 7,
                                                                      .word = Word::release,
                                                                      .outcome = RequestOutcome::overruled,
                                                                      .overruled_by = Word::stop,
                                                                      .state = State::flight}));
  EXPECT_EQ(json.at("request").at("text"), "release: overruled by stop");
  EXPECT_EQ(json.at("request").at("received_ns"), 1000);
  EXPECT_EQ(json.at("request").at("time_ns"), 2000);
  EXPECT_EQ(json.at("request").at("state"), "flight");
}

}  // namespace
}  // namespace sandhopper
