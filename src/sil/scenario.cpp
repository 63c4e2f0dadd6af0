#include "sil/scenario.hpp"

#include <algorithm>
#include <limits>

#include "files/config_reader.hpp"

namespace pmg::sil {

namespace {

constexpr double kLongest_s = 86'400.0;
constexpr std::size_t kMostSteps = 10'000;

const std::vector<std::string> kModeNames = {"passive", "damping", "stand", "walk"};

control::Mode mode_named(const std::string& name) {
  return static_cast<control::Mode>(std::ranges::find(kModeNames, name) - kModeNames.begin());
}

Command read_command(files::ConfigReader reader) {
  Command command;
  for (std::size_t i = 0; i < kChannels; ++i) command.u[i] = reader.optional<double>(kChannelNames[i], 0.0);
  reader.finish();
  return command;
}

}  // namespace

double Scenario::duration_s() const { return steps.back().start_s + steps.back().duration_s; }

const ScenarioStep& Scenario::at(double time_s) const {
  const auto after = std::ranges::upper_bound(steps, time_s, {}, &ScenarioStep::start_s);
  return after == steps.begin() ? steps.front() : *(after - 1);
}

Scenario bench_scenario(const std::string& joint, double excitation_s) {
  constexpr double kEntry_s = 2.0, kDamping_s = 0.5;
  ScenarioStep stand, damping;
  stand.duration_s = damping.start_s = excitation_s + kEntry_s;
  stand.text = "excite " + joint;
  damping.duration_s = kDamping_s;
  damping.text = "damping";
  damping.mode = control::Mode::kDamping;
  return {.name = "bench of " + joint, .steps = {stand, damping}};
}

Scenario endless_scenario() {
  ScenarioStep step;
  step.duration_s = std::numeric_limits<double>::infinity();
  step.text = "operators drive";
  return {.name = "operators", .steps = {step}};
}

Scenario load_scenario(const std::filesystem::path& file) {
  files::ConfigReader reader = files::ConfigReader::from_file(file);
  Scenario scenario;
  scenario.name = reader.required<std::string>("name");
  ScenarioStep step;
  for (files::ConfigReader& entry : reader.maps("steps")) {
    step.start_s += step.duration_s;
    step.duration_s = entry.required<double>("for_s", files::positive());
    step.text = entry.required<std::string>("text");
    if (entry.has("mode")) step.mode = mode_named(entry.one_of("mode", kModeNames));
    step.command = entry.has("command") ? read_command(entry.map("command")) : Command{};
    step.hoist_without_policy = entry.optional<bool>("hoist_without_policy", step.hoist_without_policy);
    step.beyond_reach = entry.optional<bool>("beyond_reach", false);
    step.steady_without_policy = entry.optional<bool>("steady_without_policy", step.steady_without_policy);
    entry.finish();
    scenario.steps.push_back(step);
  }
  if (scenario.steps.size() > kMostSteps) {
    reader.fail("steps", "has " + std::to_string(scenario.steps.size()), std::to_string(kMostSteps) + " at most");
  }
  if (!scenario.steps.empty() && scenario.duration_s() > kLongest_s) {
    reader.fail("steps", "last " + std::to_string(scenario.duration_s()) + " s together", "a day (86400 s) at most");
  }
  if (scenario.steps.empty()) reader.fail("steps", "is empty", "at least one step");
  reader.finish();
  return scenario;
}

ScenarioPlayer::ScenarioPlayer(const Scenario& scenario) : scenario_(scenario), current_(&scenario.steps.front()) {
  drive_.source = request_.source = control::Source::make("scenario", 1);
  drive_.lease_s = 0.5;
}

std::size_t ScenarioPlayer::number() const noexcept {
  return static_cast<std::size_t>(current_ - scenario_.steps.data()) + 1;
}

void ScenarioPlayer::step(double time_s, std::int64_t now_ns) noexcept {
  current_ = &scenario_.at(time_s);
  ++drive_.sequence;
  drive_.command = current_->command;
  ++request_.sequence;
  drive_.stamp_ns = drive_.received_ns = request_.stamp_ns = request_.received_ns = now_ns;
  request_.mode = current_->mode;
}

}  // namespace pmg::sil
