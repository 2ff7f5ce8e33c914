#include "client/gateway/http/reply_queue.h"

#include <memory>
#include <string>
#include <variant>

#include "gtest/gtest.h"

namespace traverse::gateway {
namespace {

std::string Text(const std::optional<HttpBody>& piece) {
  const std::string* text = piece ? std::get_if<std::string>(&*piece) : nullptr;
  return text == nullptr ? "" : *text;
}

TEST(ReplyQueue, SendsLinesTogetherThatCameMeanwhile) {
  int woken = 0;
  ReplyQueue queue([&woken] { ++woken; });
  queue.Begin({});
  EXPECT_TRUE(queue.Write("a\n", true));
  EXPECT_TRUE(queue.Write("b\n", true));
  EXPECT_EQ(woken, 2);  // for the head and the first line
  EXPECT_EQ(Text(queue.TakePiece()), "a\nb\n");
  EXPECT_TRUE(queue.Write("c\n", true));
  EXPECT_EQ(woken, 3);
  EXPECT_EQ(Text(queue.TakePiece()), "c\n");
  EXPECT_EQ(queue.TakePiece(), std::nullopt);
}

TEST(ReplyQueue, KeepsTextAndFilesInTheirOrder) {
  ReplyQueue queue([] {});
  queue.Begin({});
  const std::shared_ptr<const SpoolFile> file;
  EXPECT_TRUE(queue.Write("a", false));
  EXPECT_TRUE(queue.Write(file, false));
  EXPECT_TRUE(queue.Write("b", false));
  EXPECT_FALSE(queue.Write(file, true)) << "a file while something waits";
  queue.End();
  EXPECT_EQ(Text(queue.TakePiece()), "a");
  EXPECT_TRUE(std::holds_alternative<std::shared_ptr<const SpoolFile>>(*queue.TakePiece()));
  EXPECT_FALSE(queue.ended());
  EXPECT_EQ(Text(queue.TakePiece()), "b");
  EXPECT_TRUE(queue.ended());
}

TEST(ReplyQueue, IsWorkedOnUntilItEndsUnlessItOnlyWatches) {
  ReplyQueue whole([] {});
  EXPECT_TRUE(whole.is_worked_on());
  whole.Send({});
  EXPECT_FALSE(whole.is_worked_on());

  ReplyQueue streaming([] {});
  streaming.Begin({});
  streaming.Write("a", false);
  EXPECT_TRUE(streaming.is_worked_on());
  streaming.End();
  EXPECT_FALSE(streaming.is_worked_on()) << "though there is something to send";

  HttpResponse head;
  head.only_watches = true;
  ReplyQueue watching([] {});
  watching.Begin(head);
  EXPECT_FALSE(watching.is_worked_on());
}

TEST(ReplyQueue, TakesNoMoreTextThanThereIsRoomFor) {
  ReplyQueue queue([] {});
  queue.Begin({});
  const std::string half(ReplyQueue::kMaxOptionalBytes / 2, 'a');
  EXPECT_TRUE(queue.Write(half, true));
  EXPECT_TRUE(queue.Write(half, true));
  EXPECT_FALSE(queue.Write("b", true));
  EXPECT_TRUE(queue.Write("b", false));
  EXPECT_EQ(Text(queue.TakePiece()).size(), 2 * half.size() + 1);
  EXPECT_TRUE(queue.Write(half, true));
}

}  // namespace
}  // namespace traverse::gateway
