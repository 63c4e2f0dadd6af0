// Who answers on a bus whose adapter holds answers back, loses and doubles some: no drive is counted twice, and a
// second drive is found all the same.
#include "can/roll_call.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "../sim/robots.hpp"
#include "can/emulated_drives.hpp"
#include "can/memory_link.hpp"
#include "can/mixed_drives.hpp"

namespace pmg::can {
namespace {

/// One end of a bus behind an adapter: what it receives comes in bunches, one in so many waits.
class BunchingLink final : public Link {
 public:
  explicit BunchingLink(Link& inner) : inner_(inner) {}
  std::size_t send(std::span<const drives::Message> frames) noexcept override { return inner_.send(frames); }
  std::size_t receive(std::span<drives::Message> frames) noexcept override {
    if (!open_) return 0;
    const std::size_t count = inner_.receive(frames);
    for (std::size_t i = 0; i < count; ++i) {
      ++received_;
      if (lost_every != 0 && received_ % lost_every == 0) frames[i] = drives::Message{.id = 0x7FF};
    }
    open_ = count > 0 || period == 0;
    return count;
  }
  void wait() { open_ = period == 0 || ++waits_ % period == 0; }
  BusHealth health() const noexcept override { return inner_.health(); }
  const LinkCounts& counts() const noexcept override { return inner_.counts(); }

  int period = 0, lost_every = 0;

 private:
  Link& inner_;
  int waits_ = 0, received_ = 0;
  bool open_ = true;
};

/// A leg's bus with three CiA 402 drives and one of the MIT protocol.
class RollCall : public testing::Test {
 protected:
  RollCall() {
    std::unique_ptr<test::MemoryLink> there;
    std::tie(here_, there) = test::MemoryLink::pair();
    std::vector<std::unique_ptr<Link>> far;
    far.push_back(std::move(there));
    setup_.buses.resize(1);
    drives_.emplace(setup_, std::move(far));
    link_.emplace(*here_);
  }
  std::vector<std::string> scan() {
    const Wait wait = [this] {
      drives_->answer();
      link_->wait();
    };
    return problems(setup_.buses[0], ask_bus(setup_.buses[0], *link_, wait, {}));
  }

  can::DriveSetup setup_ = test::mixed_drives(z1());
  std::unique_ptr<test::MemoryLink> here_;
  std::optional<test::EmulatedDrives> drives_;
  std::optional<BunchingLink> link_;
};

TEST_F(RollCall, AnswersThatADelayBunchesAreThoseOfOneDrive) {
  for (const int period : {0, 7, 25, 45, 90}) {  // waits of some 1 ms; a request is repeated after 20
    link_->period = period;
    for (int k = 0; k < 3; ++k) EXPECT_THAT(scan(), testing::IsEmpty()) << period;
  }
}

TEST_F(RollCall, TwoDrivesOfOneNodeAreFoundThoughTheirAnswersComeBunched) {
  drives_->drive(0, 1).twice = drives_->drive(0, 3).twice = true;
  for (const int period : {0, 7, 25, 45, 90}) {
    link_->period = period;
    EXPECT_THAT(scan(), testing::ElementsAre(
                            "left_hip_roll (can0a, node 2) answers 2 times; expected one drive of each node number",
                            "left_knee (can0a, node 4) answers 2 times; expected one drive of each node number"))
        << period;
  }
}

TEST_F(RollCall, AnswersOfAProgramThatJustEndedAreNobodysSecond) {
  for (int k = 0; k < 5; ++k) {  // its last commands, answered while the roll is called
    const drives::Message command = drives::Message::of(4, drives::kMitDisable);
    here_->send(std::span(&command, 1));
  }
  EXPECT_THAT(scan(), testing::IsEmpty());
}

TEST_F(RollCall, ALostAndADoubledAnswerChangeNoCount) {
  link_->lost_every = 5;
  for (int k = 0; k < 5; ++k) {
    for (const std::string& problem : scan()) EXPECT_THAT(problem, testing::Not(testing::HasSubstr("times"))) << k;
  }
  link_->lost_every = 0;
  int asked = 0;
  const Wait wait = [&] {
    drives_->drive(0, 3).twice = ++asked == 2;  // one of its answers comes twice
    drives_->answer();
  };
  EXPECT_THAT(problems(setup_.buses[0], ask_bus(setup_.buses[0], *link_, wait, {})), testing::IsEmpty());
}

}  // namespace
}  // namespace pmg::can
