#include "client/gcode/text/lexer.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

namespace traverse::gcode {
namespace {

Command Lex(std::string_view text) {
  Command command;
  LexLine(text, command);
  return command;
}

TEST(LineAt, LeavesTheLineEndOut) {
  const std::string_view text = "G28\r\n\nM84";

  const Line first = LineAt(text, 0);
  const Line second = LineAt(text, first.next);
  const Line third = LineAt(text, second.next);

  EXPECT_EQ(first.Text(text), "G28");
  EXPECT_EQ(first.Raw(text), "G28\r\n");
  EXPECT_EQ(second.Text(text), "");
  EXPECT_EQ(third.Text(text), "M84");
  EXPECT_EQ(third.next, text.size());
}

// Programs that write every digit of a float: IceSL its feed rates, scripts in Python all.
TEST(LexLine, CutsNumbersOffBehindTheDecimalsThatAreKept) {
  const Command c = Lex("G1 X68.01900000000001 F1041.6665039062 E5.9");
  ASSERT_TRUE(c.Is('G', 1));
  EXPECT_EQ(c.Value('X'), 68'019'000'000);
  EXPECT_EQ(c.Value('F'), 1'041'666'503'906);
  EXPECT_EQ(c.Value('E'), 5'900'000'000);
  EXPECT_EQ(Lex("G1 F1041.6665039062").Value('F'), 1'041'666'503'906);

  for (const char* line :
       {"G1 F1041.6665039062.5", "G1 F- X1.12345678901.2", "G1 F9999999999.6665039062"}) {
    EXPECT_EQ(Lex(line).kind, LineKind::kText) << line;
  }
}

TEST(LexLine, ReadsTheWordsOfMoves) {
  const Command c = Lex("G1 X121.016 Y-109.474 E.03272 ; perimeter");

  ASSERT_TRUE(c.Is('G', 1));
  EXPECT_EQ(c.words, Command::Bit('X') | Command::Bit('Y') | Command::Bit('E'));
  EXPECT_EQ(c.Value('X'), 121'016'000'000);
  EXPECT_EQ(c.Value('Y'), -109'474'000'000);
  EXPECT_EQ(c.Value('E'), 32'720'000);
  EXPECT_EQ(c.comment, "; perimeter");
}

// Wherever a number stands in its line, and whatever stands beside it.
TEST(LexLine, ReadsNumbersOfAllLengthsAlike) {
  const std::string digits = "9182736450";
  for (size_t whole = 0; whole <= 9; ++whole) {
    for (size_t decimals = 0; decimals <= 9; ++decimals) {
      for (const std::string sign : {"", "-", "+"}) {
        const std::string point = decimals > 0 || whole % 2 == 0 ? "." : "";
        const std::string number =
            sign + digits.substr(0, whole) + point + digits.substr(0, decimals);
        const char* at = number.data();
        const std::optional<Decimal> value = ParseDecimal(&at, number.data() + number.size());
        for (const std::string& line : {"G1 X" + number, "G1 Y1X" + number + "F9000",
                                        "G1 X" + number + " ;2", "G1 X" + number + "\tY7"}) {
          const Command c = Lex(line);
          if (!value) {
            EXPECT_EQ(c.kind, LineKind::kText) << line;
            continue;
          }
          ASSERT_TRUE(c.Is('G', 1)) << line;
          EXPECT_EQ(c.Value('X'), *value) << line;
        }
      }
    }
  }
  EXPECT_EQ(Lex("G1 X1.2.3").kind, LineKind::kText);
  EXPECT_EQ(Lex("G1 X12345:").kind, LineKind::kText);
  EXPECT_EQ(Lex("G1 X123\xb1").kind, LineKind::kText);
}

TEST(LexLine, TakesBlanksAndSmallLetters) {
  // Double and trailing blanks, as in the lines of wipe towers.
  EXPECT_TRUE(Lex("G1  X5.000 Y0.260   F7200  ").Is('G', 1));
  EXPECT_TRUE(Lex("g1x5y2").Is('G', 1));
  EXPECT_EQ(Lex("\tG1 X 5").Value('X'), 5 * kDecimalOne);
  EXPECT_TRUE(Lex("G01 X5").Is('G', 1));
}

TEST(LexLine, TellsCommentsBlanksAndText) {
  EXPECT_EQ(Lex("  ;TYPE:Perimeter").comment, ";TYPE:Perimeter");
  EXPECT_EQ(Lex("").kind, LineKind::kBlank);
  EXPECT_EQ(Lex("START_PRINT BED_TEMP=60").kind, LineKind::kText);
  EXPECT_EQ(Lex("SET_VELOCITY_LIMIT ACCEL=500").kind, LineKind::kText);
}

TEST(LexLine, LeavesAloneWhatItCannotRead) {
  EXPECT_EQ(Lex("N10 G1 X5*71").kind, LineKind::kText);  // line numbers and checksums
  EXPECT_EQ(Lex("G1 X5 X6").kind, LineKind::kText);      // which one?
  EXPECT_EQ(Lex("G1 X{x}").kind, LineKind::kText);       // a placeholder
  EXPECT_EQ(Lex("G1 (inline)").kind, LineKind::kText);
  EXPECT_EQ(Lex("G92.1").kind, LineKind::kText);
  EXPECT_EQ(Lex("G1 X5*12").kind, LineKind::kText);
}

TEST(ReadWords, ReadsOtherCommandsWhenAsked) {
  Command c = Lex("M204 P1000 T500 ; acceleration");
  ASSERT_TRUE(ReadWords(c));
  EXPECT_EQ(c.Value('T'), 500 * kDecimalOne);

  c = Lex("M117 Printing layer 3");
  EXPECT_TRUE(c.Is('M', 117));
  EXPECT_FALSE(ReadWords(c));
}

TEST(WordCursor, FindsTheNumbersInALine) {
  std::string found;
  for (WordCursor word("G1 X-1.5 F9000 ; X2"); word.Next();) {
    found += word.letter();
    found += word.value();
    found += ' ';
  }
  EXPECT_EQ(found, "G1 X-1.5 F9000 ");
}

}  // namespace
}  // namespace traverse::gcode
