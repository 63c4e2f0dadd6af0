#include "policy/policy_metadata.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "policy/observation_layout.hpp"

namespace pmg::policy {

namespace {

constexpr int kFormat = 1;
constexpr double kLargestGoldenTolerance = 0.01;  // for actions of order one; with more the pairs would prove nothing
constexpr double kLargestAction_rad = std::numbers::pi;  // farther than any joint of a robot moves
constexpr double kPostureTolerance_rad = 1e-6;           // the same number after writing and reading as text

[[noreturn]] void refuse_metadata(const std::string& what) { throw std::invalid_argument(what); }

template <typename T>
void expect_equal(const char* name, const T& found, const T& expected) {
  if (found != expected) refuse_metadata(fmt::format("{} is {}; this controller has {}", name, found, expected));
}

/// Names in their order; the error gives only the first difference, not both lists.
void expect_names(const char* name, const std::vector<std::string>& found, const std::vector<std::string>& expected) {
  for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
    if (found[i] != expected[i]) {
      refuse_metadata(fmt::format("{}: number {} is {}; this robot has {}", name, i, found[i], expected[i]));
    }
  }
  if (found.size() != expected.size()) {
    refuse_metadata(fmt::format("{}: {} of them; this robot has {}", name, found.size(), expected.size()));
  }
}

Variant known_variant(const std::string& name) {
  const std::optional<Variant> variant = variant_named(name);
  if (!variant)
    refuse_metadata(
        fmt::format("its variant is {}; this controller has {}", name,
                    fmt::join(std::begin(kVariantNames), std::begin(kVariantNames) + kTrainedVariants, ", ")));
  return *variant;
}

std::string term_text(const nlohmann::json& term) {
  return fmt::format("{} {} ticks ago, {} elements from {}, scale {}", term.at("name").get<std::string>(),
                     term.at("age_ticks").get<int>(), term.at("size").get<int>(), term.at("offset").get<int>(),
                     term.at("scale").get<double>());
}

void expect_layout(const nlohmann::json& found, const model::RobotModel& robot) {
  const nlohmann::json expected = nlohmann::json::parse(ObservationLayout(robot).to_json());
  const nlohmann::json &theirs = found.at("terms"), &ours = expected.at("terms");
  for (std::size_t i = 0; i < std::min(theirs.size(), ours.size()); ++i) {
    if (theirs[i] == ours[i]) continue;
    const std::string text = term_text(ours[i]);
    expect_equal(fmt::format("observation term {}", i).c_str(), term_text(theirs[i]), text);
    expect_names(fmt::format("elements of observation term {} ({})", i, text).c_str(),
                 theirs[i].at("elements").get<std::vector<std::string>>(),
                 ours[i].at("elements").get<std::vector<std::string>>());
    refuse_metadata(fmt::format("observation term {} ({}) has other properties than this controller's", i, text));
  }
  expect_equal("the number of observation terms", theirs.size(), ours.size());
  expect_equal("the observation's size", found.at("size").get<int>(), expected.at("size").get<int>());
}

JointVector joint_values(const nlohmann::json& json, const char* key, const model::RobotModel& robot) {
  const auto values = json.at(key).get<std::vector<double>>();
  if (static_cast<int>(values.size()) != robot.joint_index.size()) {
    refuse_metadata(fmt::format("{} has {} values; expected one for each of {} joints", key, values.size(),
                                robot.joint_index.size()));
  }
  const JointVector vector = Eigen::Map<const Eigen::VectorXd>(values.data(), robot.joint_index.size());
  if (!vector.allFinite()) refuse_metadata(fmt::format("{} has a value that is no number", key));
  return vector;
}

void expect_posture(const JointVector& stand, const model::RobotModel& robot) {
  Eigen::Index joint = 0;
  const double largest = (stand - robot.q_stand()).cwiseAbs().maxCoeff(&joint);
  if (largest > kPostureTolerance_rad) {
    refuse_metadata(fmt::format("it was trained to stand with {} at {} rad; robot.yaml has {} rad",
                                robot.joint_index.name(static_cast<int>(joint)), stand[joint], robot.q_stand()[joint]));
  }
}

std::vector<GoldenPair> golden_pairs(const nlohmann::json& json, std::size_t seen, std::size_t actions) {
  std::vector<GoldenPair> pairs;
  for (const nlohmann::json& pair : json) {
    pairs.push_back({pair.at("observation").get<std::vector<float>>(), pair.at("action").get<std::vector<float>>()});
    if (pairs.back().observation.size() != seen || pairs.back().action.size() != actions) {
      refuse_metadata(fmt::format("golden pair {} has {} observations and {} actions; expected {} and {}",
                                  pairs.size() - 1, pairs.back().observation.size(), pairs.back().action.size(), seen,
                                  actions));
    }
  }
  if (pairs.empty()) refuse_metadata("it has no golden pair; expected at least one observation with its action");
  return pairs;
}

PolicyMetadata checked(const nlohmann::json& json, const model::RobotModel& robot,
                       const std::string& clip_library_sha256, double control_rate_Hz) {
  expect_equal("the metadata's format", json.at("format").get<int>(), kFormat);
  PolicyMetadata metadata;
  metadata.robot = json.at("robot").get<std::string>();
  expect_equal("its robot", metadata.robot, robot.name);
  metadata.variant = known_variant(json.at("variant").get<std::string>());
  expect_names("joints", json.at("joints").get<std::vector<std::string>>(), robot.joint_index.names());
  const ObservationLayout layout(robot);
  expect_names("action joints", json.at("action_joints").get<std::vector<std::string>>(), layout.action_joints());
  expect_layout(json.at("observation"), robot);
  expect_posture(joint_values(json, "stand_rad", robot), robot);
  expect_equal("its rate in Hz", json.at("policy_rate_Hz").get<double>(), control_rate_Hz);
  if (const auto trained_on = json.at("clip_library_sha256").get<std::string>(); trained_on != clip_library_sha256) {
    refuse_metadata(
        fmt::format("it was trained on other clips; leave --clips out or give those that it was trained on, or choose "
                    "another policy. The SHA-256 of its clip library is {}; this controller has {}",
                    trained_on, clip_library_sha256));
  }
  metadata.action_scale = json.at("action_scale").get<double>();
  if (!(metadata.action_scale > 0.0) || !std::isfinite(metadata.action_scale)) {
    refuse_metadata(fmt::format("action_scale is {}; expected a positive number of rad", metadata.action_scale));
  }
  metadata.action_limit = json.at("action_limit").get<double>();
  if (!(metadata.action_limit > 0.0) || !std::isfinite(metadata.action_limit)) {
    refuse_metadata(fmt::format("action_limit is {}; expected a positive number", metadata.action_limit));
  }
  if (metadata.action_scale * metadata.action_limit > kLargestAction_rad) {
    refuse_metadata(fmt::format("action_scale {} times action_limit {} is more than {:.2f} rad, half a turn: no bound",
                                metadata.action_scale, metadata.action_limit, kLargestAction_rad));
  }
  metadata.gains = {joint_values(json, "kp_Nm_per_rad", robot), joint_values(json, "kd_Nm_s_per_rad", robot)};
  metadata.golden_tolerance = json.at("golden_tolerance").get<double>();
  if (!(metadata.golden_tolerance > 0.0) || metadata.golden_tolerance > kLargestGoldenTolerance) {
    refuse_metadata(fmt::format("golden_tolerance is {}; expected above 0 and at most {}", metadata.golden_tolerance,
                                kLargestGoldenTolerance));
  }
  metadata.golden =
      golden_pairs(json.at("golden"), static_cast<std::size_t>(layout.size()), layout.action_joints().size());
  return metadata;
}

}  // namespace

PolicyMetadata parse_policy_metadata(const std::string& json, const model::RobotModel& robot,
                                     const std::string& clip_library_sha256, double control_rate_Hz) {
  try {
    return checked(nlohmann::json::parse(json), robot, clip_library_sha256, control_rate_Hz);
  } catch (const nlohmann::json::exception& error) {
    refuse_metadata(fmt::format("its metadata can't be read: {}", error.what()));
  }
}

}  // namespace pmg::policy
