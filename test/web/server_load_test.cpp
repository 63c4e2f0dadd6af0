// The server under floods, slow pages, idle connections and bytes that no browser sends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "web/server_fixture.hpp"

namespace pmg::web {
namespace {

using ServerLoad = ServerTest;
using SlowLink = ServerTest;

TEST_F(ServerLoad, AFloodIsDroppedAndAStopPassesIt) {
  const auto paired = page();
  std::string flood;
  for (int k = 0; k < 500; ++k) flood += Browser::frame("x", 1);
  paired->send(flood + Browser::frame(Server::kStop, 1) +
               flood.substr(0, flood.size() / 5));  // amid it, where no allowance is left
  std::size_t others = 0;
  bool stopped = false;
  until([&] {
    for (const Said& one : server_.take()) (one.text == Server::kStop ? stopped = true : (++others, false));
    return stopped;
  });
  EXPECT_LT(others, 250U);
  EXPECT_GE(server_.counts().flooded, 250U);
  paired->send(flood + flood + flood);
  EXPECT_EQ(paired->hear(), std::nullopt);
  EXPECT_EQ(paired->close_code(), 1008);
}

TEST_F(ServerLoad, AFloodOfPingsEndsItsPageAlone) {
  const auto other = page();
  const auto reader = page("");
  std::string flood;
  for (std::uint64_t k = 0; k < 2 * Server::kMostDropped; ++k) flood += Browser::frame("", 9);
  reader->send(flood);
  EXPECT_EQ(reader->hear(), std::nullopt);
  until([&] { return server_.pages().size() == 1; });
  EXPECT_GT(server_.counts().flooded, Server::kMostDropped);
  expect_answers(*other);
}

TEST_F(ServerLoad, UnreadMessagesAreBoundedAndTheNewestStay) {
  const auto paired = page();
  // Its allowance has less room than there is for unread messages: what is dropped waits for more of it.
  for (int k = 0; server_.counts().messages < Server::kMostUnread + 10 && k < 1000; ++k) {
    const std::uint64_t flooded = server_.counts().flooded;
    const auto again = std::chrono::steady_clock::now() + std::chrono::milliseconds(10);
    paired->say(std::to_string(k));
    until([&] { return server_.counts().messages + server_.counts().flooded > static_cast<std::uint64_t>(k); });
    if (server_.counts().flooded > flooded) until([&] { return std::chrono::steady_clock::now() > again; });
  }
  const std::vector<Said> left = server_.take();
  EXPECT_EQ(left.size(), Server::kMostUnread);
  EXPECT_EQ(left.size() + server_.counts().overrun, server_.counts().messages);
}

TEST_F(ServerLoad, ASlowPageMissesStatesAndGetsTheNewest) {
  const auto slow = page(), quick = page();
  const std::vector<Page> pages = server_.pages();
  constexpr int kStates = 2000;
  int at_slow = 0;
  for (int k = 1; k <= kStates; ++k) {
    server_.show(pages[0].id, fmt::format("{:>4000}", k));
    server_.show(pages[1].id, std::to_string(k));
  }
  // It has confirmed nothing, so it was sent no more than so many; the newest comes as soon as it has.
  std::vector<int> heard;
  std::uint64_t unconfirmed = 0;
  while (unconfirmed < Server::kMostOnTheWay) {
    const auto frame = slow->frame();
    ASSERT_TRUE(frame);
    if (frame->opcode == 1) heard.push_back(std::stoi(frame->text));
    if (frame->opcode == 9) ++unconfirmed;
  }
  EXPECT_EQ(heard.size(), Server::kMostOnTheWay);
  slow->say(std::to_string(unconfirmed), 10);
  at_slow = std::stoi(slow->hear().value_or("0"));
  EXPECT_EQ(at_slow, kStates);
  int at_quick = 0;
  while (at_quick < kStates) {
    const int next = std::stoi(quick->hear().value_or("9999"));
    EXPECT_GT(next, at_quick) << "never an old one";
    at_quick = next;
  }
  EXPECT_EQ(at_quick, kStates);
}

TEST_F(ServerLoad, APageThatReadsNothingHasNoMoreThanThreeStatesQueued) {
  const auto deaf = page(), other = page();
  const std::vector<Page> pages = server_.pages();
  constexpr std::size_t kState_bytes = 20'000;
  constexpr int kStates = 3000;  // a minute of them at fifty a second
  for (int k = 0; k < kStates; ++k) server_.show(pages[0].id, std::string(kState_bytes, 's'));
  server_.show(pages[1].id, "after them all");
  EXPECT_EQ(other->hear(), "after them all");
  const Counts counts = server_.counts();
  EXPECT_LE(counts.states, Server::kMostOnTheWay + 1);
  EXPECT_LE(counts.state_bytes, Server::kMostOnTheWay * kState_bytes + 14);
}

/// The page confirms one state in so long as ten are shown, for as long as a person waits for a link to come back.
TEST_F(SlowLink, AMinuteAtATenthOfTheRateGivesTheNewestAndQueuesNothing) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kPeriod = std::chrono::milliseconds(50), kReads = 10 * kPeriod;
  const auto slow = page();
  const std::int32_t id = server_.pages().front().id;
  const auto begin = Clock::now();
  std::jthread shower([&] {
    for (int k = 0; k < 1200; ++k) {
      server_.show(id, fmt::format("{:>4000}", k));
      std::this_thread::sleep_until(begin + (k + 1) * kPeriod);
    }
  });
  int heard = 0, behind_most = 0, before = -1;
  for (auto at = begin + kReads; at < begin + std::chrono::seconds(60); at += kReads) {
    std::this_thread::sleep_until(at);
    const auto text = slow->hear();  // answers the ping of the state before
    if (!text) break;
    const int state = std::stoi(*text), newest = static_cast<int>((Clock::now() - begin) / kPeriod);
    EXPECT_GT(state, before);
    before = state;
    ++heard;
    behind_most = std::max(behind_most, newest - state);
  }
  shower.join();
  EXPECT_GT(heard, 100);
  // Each of those on the way was the newest when it was sent, one reading after the other.
  EXPECT_LE(behind_most, 10 * static_cast<int>(Server::kMostOnTheWay + 1));
  EXPECT_LE(server_.counts().states, static_cast<std::uint64_t>(heard) + Server::kMostOnTheWay + 1);
}

TEST_F(ServerLoad, TwoHundredIdleConnectionsHinderNobody) {
  const auto paired = page();
  std::vector<std::unique_ptr<Browser>> idle;
  for (int k = 0; k < 200; ++k) idle.push_back(std::make_unique<Browser>(server_.port(), k % 20 == 0));
  expect_answers(*paired);
  EXPECT_EQ(status_of(get("/")), 200);
  const auto another = page();
  expect_answers(*another);
  EXPECT_GE(server_.counts().full, 200U - Server::kMostWaiting);
}

TEST_F(ServerLoad, ReadersMakeRoomForReadersAndNeverTakeAPairedPagesPlace) {
  std::vector<std::unique_ptr<Browser>> readers, paired;
  for (std::size_t k = 0; k < Server::kMostReaders + 2; ++k) readers.push_back(page(""));
  EXPECT_EQ(readers[0]->hear(), std::nullopt);
  EXPECT_EQ(readers[1]->hear(), std::nullopt);
  EXPECT_EQ(readers[1]->close_code(), 1013);
  for (std::size_t k = 0; k < Server::kMostPaired; ++k) paired.push_back(page());
  EXPECT_EQ(Browser(server_.port()).open(kToken), 503);
  EXPECT_EQ(server_.pages().size(), Server::kMostReaders + Server::kMostPaired);
  paired.pop_back();
  until([&] { return server_.pages().size() < Server::kMostReaders + Server::kMostPaired; });
  expect_answers(*page());
}

TEST_F(ServerLoad, BrowsersThatDoNotCloseKeepNoMoreThanAFewSocketsOpen) {
  const auto sockets = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
  };
  const auto before = sockets();
  constexpr int kPages = 100;
  std::vector<std::unique_ptr<Browser>> readers;
  for (int k = 0; k < kPages; ++k) {
    readers.push_back(page(""));
    readers.back()->say(std::string(Server::kMostMessage_bytes + 1, 'x'));
    EXPECT_EQ(readers.back()->hear(), std::nullopt) << "told to close";
  }
  until([&] { return sockets() - before - kPages <= 40; });
  expect_answers(*page());
}

TEST_F(ServerLoad, FramesThatAreNoneEndTheirPageAlone) {
  const auto other = page();
  const std::vector<std::string> wrong = {
      Browser::frame("unmasked", 1, true, false), Browser::frame("reserved", 3),
      Browser::frame("continues nothing", 0),     Browser::frame(std::string(200, 'p'), 9),
      std::string("\xf1\x80\0\0\0\0", 6),         Browser::frame("\xff\xfe broken", 1)};
  for (const std::string& bytes : wrong) {
    const auto paired = page();
    paired->send(bytes);
    EXPECT_EQ(paired->hear(), std::nullopt) << bytes;
  }
  const auto binary = page();
  binary->say("bytes", 2);
  until([&] { return server_.counts().binary == 1; });
  EXPECT_TRUE(server_.take().empty());
  expect_answers(*other);
}

TEST_F(ServerLoad, RandomBytesHarmNobody) {
  const auto other = page();
  std::mt19937 random(18);
  const auto number = [&](std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(random);
  };
  const auto bytes = [&](std::size_t most) {
    std::string text(number(most), '\0');
    for (char& c : text) c = static_cast<char>(number(256));
    return text;
  };
  const std::string request =
      "GET / HTTP/1.1\r\nHost: localhost\r\nOrigin: https://localhost\r\nSec-WebSocket-Protocol: pmg\r\n\r\n";
  for (int k = 0; k < 150; ++k) {
    const std::size_t kind = number(4);
    if (kind == 0) {
      Browser(server_.port(), false).send(bytes(500));
      continue;
    }
    if (kind == 1) {
      std::string changed = request;
      for (std::size_t n = number(6); n > 0; --n) changed[number(changed.size())] = static_cast<char>(number(256));
      Browser(server_.port()).send(changed.substr(0, number(changed.size())));
      Browser(server_.port()).ask(changed + "\r\n\r\n");
      continue;
    }
    Browser browser(server_.port());
    browser.open(kind == 2 ? kToken : "");
    for (std::size_t n = number(8); n > 0; --n)
      browser.send(number(2) == 0 ? bytes(300)
                                  : Browser::frame(bytes(300), static_cast<int>(number(16)), number(2) == 0));
  }
  until([&] { return server_.pages().size() == 1; });
  server_.take();
  expect_answers(*other);
  EXPECT_EQ(status_of(get("/")), 200);
}

}  // namespace
}  // namespace pmg::web
