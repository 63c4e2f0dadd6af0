// A search, as in protocol_model_test.cpp, through what recordings can do to a controller that starts and to an
// operator whose controller may be dead. The judges are the real ones.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "runtime/name_contest.hpp"
#include "seal/status_order.hpp"
#include "sequence_search.hpp"

namespace pmg::runtime::model {
namespace {

/// Names: two controllers may start, and everything that was said at earlier starts is played back.
class Names {
 public:
  static constexpr std::array kActions = {
      "the first asks",           "the first asks, unheard",       "the second asks",
      "the second asks, unheard", "recordings are played to both", "the first has listened for long enough"};

  void act(std::size_t action) {
    switch (action) {
      case 0:
        ask(first_, second_);
        second_lives_ = true;
        break;
      case 2:
        ask(second_, first_);
        second_lives_ = true;
        break;
      case 4:
        for (const std::int64_t answers : {pmg_msgs::claim_t::NOBODY, kEarlier, kEarlier + 1}) {
          for (const bool held : {false, true}) {
            hear(first_, {.stamp_ns = 0, .robot = "z1", .session = 1, .held = held, .answers = answers}, kEarlier - 1);
            hear(second_, {.stamp_ns = 0, .robot = "z1", .session = 1, .held = held, .answers = answers}, kEarlier - 1);
          }
        }
        break;
      case 5:
        if (!first_.yielded) first_.contest.hold();
        break;
      default:
        break;
    }
    if (first_.yielded && second_.yielded) violation_ = "both give way";
    if (first_.yielded && !second_lives_) violation_ = "a recording prevents a start";
    if (first_.met && !second_lives_) violation_ = "a recording is taken for another controller";
    if (second_.heard_answer && !second_.yielded) violation_ = "both keep the name";
  }
  const std::string& violation() const { return violation_; }

 private:
  static constexpr std::int64_t kEarlier = 5;
  struct Controller {
    std::int64_t boot;
    NameContest contest{boot};
    bool yielded = false, met = false, heard_answer = false;
  };

  static NameContest::Reaction hear(Controller& who, const pmg_msgs::claim_t& claim, std::int64_t boot) {
    const auto reaction = who.contest.hear(claim, boot);
    who.yielded = who.yielded || reaction == NameContest::Reaction::kYield;
    who.met = who.met || reaction == NameContest::Reaction::kMet;
    return reaction;
  }
  static void ask(Controller& asks, Controller& hears) {
    if (asks.yielded || hears.yielded) return;
    const pmg_msgs::claim_t question{
        .stamp_ns = 0, .robot = "z1", .session = 1, .held = asks.contest.holds(), .answers = pmg_msgs::claim_t::NOBODY};
    if (hear(hears, question, asks.boot) != NameContest::Reaction::kAnswer) return;
    asks.heard_answer = true;
    hear(asks, {.stamp_ns = 0, .robot = "z1", .session = 1, .held = hears.contest.holds(), .answers = asks.boot},
         hears.boot);
  }

  Controller first_{.boot = 10}, second_{.boot = 11};
  bool second_lives_ = false;
  std::string violation_;
};

TEST(RecordingsModel, NoRecordingPreventsAStartAndOfTwoControllersOneGivesWay) { search<Names>(6); }

/// What an operator's program knows of a controller that may be dead, while all that it ever said is played back.
class Knowledge {
 public:
  static constexpr std::array kActions = {"the controller speaks",
                                          "it speaks, unheard",
                                          "it dies",
                                          "its first STATUS is played back",
                                          "its STATUS are played back in order",
                                          "the operator's program is started anew",
                                          "0.6 s pass"};

  void act(std::size_t action) {
    pass_ms(10);
    switch (action) {
      case 0:
      case 1:
        if (!alive_) break;
        said_.push_back({.stamp_ns = now_ns_, .session = heard_ ? session_ : 0});  // who has heard nothing can't drive
        spoke_ns_ = now_ns_;
        if (action == 0) hear(said_.back());
        break;
      case 2:
        alive_ = false;
        break;
      case 3:
        if (!said_.empty()) hear(said_.front());
        break;
      case 4:
        for (std::size_t k = 0; k < said_.size(); ++k) {
          hear(said_[k]);
          pass_ms(10);
        }
        break;
      case 5:
        order_ = {};
        heard_ = false;
        ++session_;
        drives_ns_ = kNever;
        break;
      default:
        pass_ms(600);
    }
    const bool drives = now_ns_ - drives_ns_ < kBelieved_ns;
    if (drives && now_ns_ - spoke_ns_ > kBelieved_ns + seal::StatusOrder::kLate_ns) violation_ = "a dead robot drives";
  }
  const std::string& violation() const { return violation_; }

 private:
  static constexpr std::int64_t kNever = -1'000'000'000'000, kBelieved_ns = 500 * kMillisecond_ns;
  struct Status {
    std::int64_t stamp_ns, session;  // session: who drives
  };
  void pass_ms(std::int64_t ms) { now_ns_ += ms * kMillisecond_ns; }
  void hear(const Status& status) {
    if (!order_.take(1, status.stamp_ns, now_ns_)) return;
    heard_ = true;
    if (status.session == session_) drives_ns_ = now_ns_;
  }

  seal::StatusOrder order_;
  std::vector<Status> said_;
  std::int64_t now_ns_ = 0, session_ = 1, spoke_ns_ = kNever, drives_ns_ = kNever;
  bool alive_ = true, heard_ = false;
  std::string violation_;
};

TEST(RecordingsModel, NoRecordingDrivesADeadRobot) { search<Knowledge>(7); }

}  // namespace
}  // namespace pmg::runtime::model
