// What a program learns of the backends of its build, and what a backend is made from.
#include "hal/backend_factory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "../sim/robots.hpp"
#include "refusal.hpp"

namespace pmg::hal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Drives on a serial line whose speed is an option: slower than a bus, so it allows older states.
class SerialBackend final : public Backend, Hal {
 public:
  explicit SerialBackend(const BackendSetup& setup) : options_(setup.options) {
    if (std::get<std::uint64_t>(options_.at("baud")) == 0) throw std::invalid_argument("baud: is 0");
  }
  OptionValues configuration() const override { return options_; }
  BackendLimits limits() const override {
    return {.guard = {.max_kp_Nm_per_rad = 50.0}, .stale_state_s = 0.1, .overrun_ticks = std::nullopt};
  }
  Hal& connect(const std::function<bool()>& interrupted) override {
    if (interrupted()) throw std::runtime_error("given up");
    return *this;
  }
  BusStatus exchange(const model::JointCommand&, model::RobotState&) noexcept override { return BusStatus::kOk; }

 private:
  OptionValues options_;
};

BackendKind serial(const std::string& name) {
  return {.name = name,
          .summary = "drives on a serial line",
          .options = {{"baud", "bits a second", std::uint64_t{1'000'000}}},
          .make = [](const BackendSetup& setup) { return std::make_unique<SerialBackend>(setup); }};
}

std::string refusal(const BackendFactory& factory, const std::string& name) {
  return test::refusal_by<std::invalid_argument>([&] { factory.kind(name); });
}

TEST(BackendFactory, NamesWhatTheBuildHasAndWhatItLacks) {
  BackendFactory factory;
  factory.lacks("can", "CAN backend");
  factory.lacks("sil", "simulated robot");
  EXPECT_EQ(factory.help(), "the drives: this build has no backend; can and sil are not in it");
  EXPECT_EQ(refusal(factory, "sil"), "--hal sil: this build has no simulated robot; it has no other backend either");

  factory.add(serial("serial"));
  EXPECT_THAT(factory.names(), ElementsAre("serial", "can", "sil"));
  EXPECT_EQ(factory.help(),
            "the drives: serial, drives on a serial line, is the one backend of this build; can and sil are not in it");
  EXPECT_EQ(refusal(factory, "can"), "--hal can: this build has no CAN backend; expected serial, the one that it has");
  EXPECT_EQ(refusal(factory, "serial"), "taken");

  factory.add(serial("second"));
  EXPECT_EQ(factory.help(),
            "the drives: serial, drives on a serial line; second, drives on a serial line; can and sil are not in it");
  EXPECT_EQ(refusal(factory, "sil"), "--hal sil: this build has no simulated robot; expected one of serial, second");
  EXPECT_EQ(refusal(factory, "pigeon"), "--hal pigeon: this build has no such backend; expected one of serial, second");
}

TEST(BackendFactory, TwoBackendsOfOneNameAreAProgrammersError) {
  BackendFactory factory;
  factory.add(serial("serial"));
  factory.lacks("can", "CAN backend");
  EXPECT_THROW(factory.add(serial("serial")), std::logic_error);
  EXPECT_THROW(factory.add(serial("can")), std::logic_error) << "said to be missing";
}

TEST(BackendFactory, ABackendIsMadeFromItsOptionsAndOffersNoMoreThanItHas) {
  BackendFactory factory;
  factory.add(serial("serial"));
  const io::SimulationClock clock;
  BackendSetup setup{.robot = z1(),
                     .clock = clock,
                     .name = "z1",
                     .lcm_url = "memq://",
                     .benched_joint = "",
                     .keeps_truth = true,
                     .options = {{"baud", std::uint64_t{115'200}}}};
  const std::unique_ptr<Backend> backend = factory.kind("serial").make(setup);
  EXPECT_EQ(std::get<std::uint64_t>(backend->configuration().at("baud")), 115'200u);
  EXPECT_EQ(backend->limits().stale_state_s, 0.1);
  model::RobotState state;
  EXPECT_EQ(backend->connect([] { return false; }).exchange({}, state), BusStatus::kOk);
  EXPECT_EQ(backend->hoist(), nullptr);
  EXPECT_EQ(backend->window(), nullptr);
  EXPECT_EQ(backend->take_truth(0), nullptr);
  EXPECT_THROW(backend->connect([] { return true; }), std::runtime_error);

  setup.options["baud"] = std::uint64_t{0};
  EXPECT_THROW(factory.kind("serial").make(setup), std::invalid_argument);
}

}  // namespace
}  // namespace pmg::hal
