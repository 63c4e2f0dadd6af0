// Training's references are the deployed generator's, and nothing but them.
#include "pmg_batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "folders.hpp"
#include "gco/ground_aware_command.hpp"
#include "gco/motion_composition.hpp"
#include "model/clip_library_file.hpp"
#include "model/robot_model.hpp"
#include "pmg/generator.hpp"

namespace pmg::test {
namespace {

const std::string kRobot = pmg::test::project_folder() + "/config/robots/z1";
constexpr float kRounding = 1e-6F;  // of doubles of order one written as float

using Batch = std::unique_ptr<pmg_batch, void (*)(pmg_batch*)>;

Batch batch(const char* variant, int streams, std::uint64_t seed, int threads) {
  return {pmg_batch_create(kRobot.c_str(), variant, streams, seed, threads), pmg_batch_destroy};
}

struct Columns {
  explicit Columns(const pmg_batch* batch) : json(nlohmann::json::parse(pmg_batch_description(batch))) {}
  std::size_t row() const { return json["row_size"].get<std::size_t>(); }
  std::size_t of(const std::string& name) const {
    for (const auto& field : json["fields"]) {
      if (field["name"] == name) return field["offset"].get<std::size_t>();
    }
    throw std::out_of_range(name);
  }
  nlohmann::json json;
};

TEST(PmgBatch, RowsAreWhatTheControllersGeneratorAndOptimisationGive) {
  const model::RobotModel robot = model::load_robot(kRobot);
  const ClipLibrary library = model::load_clip_library(robot.directory / "clips", robot);
  Generator generator(library, gco::generator_options(robot));
  gco::GroundAwareCommand gco(robot);

  const Batch one = batch("pmg", 1, 1, 1);
  ASSERT_NE(one, nullptr) << pmg_batch_error();
  const Columns columns(one.get());
  std::vector<float> row(columns.row());
  const Command user{{0.4, 0.1, 0.3, 0.1, 0.05, -0.05}};
  const std::vector<float> asked(user.u.begin(), user.u.end());
  for (int tick = 0; tick < 300; ++tick) {
    ASSERT_EQ(pmg_batch_run(one.get(), 1, asked.data(), row.data()), 0);
    Command in_float;  // the interface takes floats
    for (std::size_t c = 0; c < kChannels; ++c) in_float.u[c] = static_cast<double>(asked[c]);
    const Reference& reference = generator.step(in_float, 0.01);
    const Command optimised = gco.solve(reference).command;
    for (Eigen::Index i = 0; i < reference.q.size(); ++i) {
      const auto joint = static_cast<std::size_t>(i);
      ASSERT_NEAR(row[columns.of("q_ref") + joint], reference.q[i], kRounding) << "tick " << tick;
      ASSERT_NEAR(row[columns.of("dq_ref") + joint], reference.dq[i], 10 * kRounding) << "tick " << tick;
    }
    for (std::size_t c = 0; c < kChannels; ++c) {
      ASSERT_NEAR(row[columns.of("optimised") + c], optimised.u[c], kRounding) << "tick " << tick;
    }
  }
}

TEST(PmgBatch, RandomStreamsDependOnTheSeedAloneNotOnThreads) {
  constexpr int kStreams = 40, kTicks = 200;
  const Batch alone = batch("pmg", kStreams, 7, 1), together = batch("pmg", kStreams, 7, 4);
  const std::size_t size = Columns(alone.get()).row() * kStreams * kTicks;
  std::vector<float> a(size), b(size);
  ASSERT_EQ(pmg_batch_run(alone.get(), kTicks, nullptr, a.data()), 0);
  ASSERT_EQ(pmg_batch_run(together.get(), kTicks, nullptr, b.data()), 0);
  EXPECT_EQ(a, b);
  for (const float value : a) ASSERT_TRUE(std::isfinite(value));
}

TEST(PmgBatch, BaselinesSeeTheUsersCommandInsteadOfTheOptimisedOne) {
  for (const char* variant : {"without_gco", "single_gait"}) {
    const Batch one = batch(variant, 1, 3, 1);
    const Columns columns(one.get());
    std::vector<float> row(columns.row());
    const std::vector<float> turn = {0.0F, 0.0F, 0.6F, 0.0F, 0.0F, 0.0F};
    for (int tick = 0; tick < 200; ++tick) pmg_batch_run(one.get(), 1, turn.data(), row.data());
    for (std::size_t c = 0; c < kChannels; ++c) {
      EXPECT_FLOAT_EQ(row[columns.of("optimised") + c], row[columns.of("command") + c]) << variant;
    }
    EXPECT_NEAR(row[columns.of("command") + kOmega], 0.6F, kRounding) << variant;
  }
}

TEST(PmgBatch, SaysWhatIsWrong) {
  EXPECT_EQ(pmg_batch_create(kRobot.c_str(), "imitation", 1, 1, 1), nullptr);
  EXPECT_NE(std::string(pmg_batch_error()).find("single_gait"), std::string::npos);
  EXPECT_EQ(pmg_batch_create("/nowhere", "pmg", 1, 1, 1), nullptr);
}

}  // namespace
}  // namespace pmg::test
