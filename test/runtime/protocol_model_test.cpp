// A search through what two operators, a recorder, a stranger and a network that loses messages can do to the
// controller's receiving part, which is the real one: every sequence of actions to a depth. Each rule of
// docs/reference/network.md ("Who remembers what") that is taken out gives a sequence that is reported here.
#include "protocol_model.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sequence_search.hpp"

namespace pmg::runtime::model {
namespace {

using Modes = pmg_msgs::mode_t;

/// Requests: refused, taken, repeated, lost, played back, and acknowledgements.
class Requests {
 public:
  static constexpr std::array kActions = {"anna asks for Stand",
                                          "anna's request for Stand is lost",
                                          "anna repeats her request",
                                          "bob drives",
                                          "bob stops",
                                          "a stranger stops with anna's name and number",
                                          "anna's first message is played back",
                                          "anna's last message is played back",
                                          "seventy others stop, each for the first time",
                                          "0.6 s pass and STATUS is heard"};

  void act(std::size_t action) {
    world_.pass_ms(10);
    switch (action) {
      case 0:
      case 1: {
        messages_.push_back(world_.new_request(world_.anna, Modes::STAND));
        if (action == 0) world_.gate->take_mode(messages_.back());
        break;
      }
      case 2:
        if (messages_.empty()) break;
        messages_.push_back(world_.request(world_.anna));
        world_.gate->take_mode(messages_.back());
        break;
      case 3:
        world_.gate->take_command(world_.drive(world_.bob));
        break;
      case 4:
        world_.gate->take_mode(world_.new_request(world_.bob, Modes::DAMPING));
        break;
      case 5: {
        Modes stop = world_.anna.mode;
        stop.mode = Modes::DAMPING;
        world_.gate->take_mode(World::bare(stop));
        break;
      }
      case 6:
      case 7:
        if (!messages_.empty()) world_.gate->take_mode(action == 6 ? messages_.front() : messages_.back());
        break;
      case 8:
        for (int k = 0; k < 70; ++k) {
          Sender other("o" + std::to_string(others_++));
          other.peer = world_.bob.peer;
          other.peer.heard_ns = world_.clock.now_ns();
          world_.gate->take_mode(world_.new_request(other, Modes::DAMPING));
          if (k % 7 == 6) world_.tick();
        }
        break;
      default:
        world_.pass_ms(590);  // a lease is over, a seal is still fresh
        world_.tick();
        for (Sender* sender : {&world_.anna, &world_.bob}) world_.hear_status(*sender);
    }
    world_.tick();
  }
  const std::string& violation() const { return world_.violation; }

 private:
  World world_;
  std::vector<Packet> messages_;  // anna's, as they were on the network
  int others_ = 0;
};

TEST(ProtocolModel, NoRequestIsCarriedOutTwiceOrAfterItsRefusalOrAStopAndEveryAnswerIsItsOwn) { search<Requests>(4); }

TEST(ProtocolModel, NoRequestIsCarriedOutTwiceOrAfterItsRefusalOrAStopInFiveSteps) { search<Requests>(5); }

/// Allowances: anna drives at 50 Hz and repeats a request every 50 ms; nobody takes room from her. And the hoist.
class Allowances {
 public:
  static constexpr std::array kActions = {"nothing happens",
                                          "anna's newest command is played back ten times",
                                          "anna's newest request is played back ten times",
                                          "bob sends commands under twelve names",
                                          "bob asks under twelve names",
                                          "bob stops under twelve names",
                                          "strangers stop twenty times",
                                          "anna lifts the robot",
                                          "carl sets it down",
                                          "the hoist's first request is played back",
                                          "anna repeats her request to the hoist",
                                          "anna is silent while bob sends commands under twelve names"};

  Allowances() { world_.anna.mode.mode = Modes::STAND; }

  void act(std::size_t action) {
    const bool silent = action == 11;
    for (int k = 0; k < (silent ? 30 : 5); ++k) {
      world_.pass_ms(20);
      for (Sender* sender : {&world_.anna, &carl_}) world_.hear_status(*sender);
      if (!silent) world_.gate->take_command(command_ = world_.drive(world_.anna));
      if (!silent && k % 2 == 0) world_.gate->take_mode(request_ = world_.request(world_.anna));
      interfere(silent ? 3 : action);
      world_.tick();
    }
    if (silent) return;
    hoist(action);
    const int commands = world_.commands["anna.1"], requests = world_.requests["anna.1"];
    if (commands != 5 * (1 + steps_)) violation_ = "another takes room from a driver's commands";
    if (requests != 3 * (1 + steps_)) violation_ = "another takes room from an operator's requests";
    ++steps_;
  }
  const std::string& violation() const { return violation_; }

 private:
  void interfere(std::size_t action) {
    for (int k = 0; k < 10 && action == 1; ++k) world_.gate->take_command(command_);
    for (int k = 0; k < 10 && action == 2; ++k) world_.gate->take_mode(request_);
    for (int k = 0; k < 12 && action >= 3 && action <= 5; ++k) {
      Sender& bob = names_[static_cast<std::size_t>(k)];
      world_.hear_status(bob);
      if (action == 3) world_.gate->take_command(world_.drive(bob));
      if (action > 3) world_.gate->take_mode(world_.new_request(bob, action == 4 ? Modes::STAND : Modes::DAMPING));
    }
    for (int k = 0; k < 20 && action == 6; ++k) {
      Modes stop = world_.anna.mode;
      stop.mode = Modes::DAMPING;
      world_.gate->take_mode(World::bare(stop));
    }
  }
  void ask_hoist(Sender& sender, bool lift) {
    sender.hoist.stamp_ns = world_.clock.now_ns();
    sender.hoist.request = lift ? pmg_msgs::hoist_t::LIFT : pmg_msgs::hoist_t::LOWER;
    const Packet packet = world_.sealed("HOIST", sender.hoist, sender);
    if (first_hoist_.empty()) first_hoist_ = packet;
    world_.hoist_gate->take(packet);
  }
  void hoist(std::size_t action) {
    const bool up = world_.hoist_line.stays_up();
    if (action == 7 || action == 8) {
      Sender& sender = action == 7 ? world_.anna : carl_;
      ++sender.hoist.sequence;
      ask_hoist(sender, action == 7);
      if (world_.hoist_line.stays_up() != (action == 7)) violation_ = "a request to the hoist has no effect";
      return;
    }
    if (action == 9 && !first_hoist_.empty()) world_.hoist_gate->take(first_hoist_);
    if (action == 10 && world_.anna.hoist.sequence > 0) ask_hoist(world_.anna, true);
    if (world_.hoist_line.stays_up() != up) violation_ = "a request to the hoist is carried out twice";
  }

  World world_;
  Sender carl_{"carl.1"};
  std::vector<Sender> names_ = [] {
    std::vector<Sender> names;
    for (int k = 0; k < 12; ++k) names.emplace_back("bob." + std::to_string(100 + k));
    return names;
  }();
  Packet command_, request_, first_hoist_;
  int steps_ = 0;
  std::string violation_;
};

TEST(ProtocolModel, NobodyTakesRoomFromAnotherAndNoHoistMovesTwice) { search<Allowances>(3); }

}  // namespace
}  // namespace pmg::runtime::model
