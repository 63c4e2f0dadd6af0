// A diagnosis of runs from several assemblies of one joint.
#include "diagnosis/assemblies.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "calib/unknown.hpp"
#include "diagnosis/diagnosis_json.hpp"
#include "diagnosis_page/diagnosis_page.hpp"
#include "rules_fixture.hpp"

namespace pmg::diagnosis {
namespace {

class Assemblies : public Rules {
 protected:
  /// The bench in files: four runs of each arm, with the column `arm` beside the usual ones.
  bench::Bench of_arms(const std::vector<calib::JointModel>& arms) const {
    std::vector<calib::SingleJoint> joints;
    for (std::size_t arm = 0; arm < arms.size(); ++arm) {
      for (const calib::SingleJoint& joint :
           test::record(bench_, arms[arm], 4, 1e-3, static_cast<unsigned>(10 + arm))) {
        bench::BenchRun run = joint.run();
        run.file = fmt::format("arm{}_{}", arm, run.file);
        joints.emplace_back(bench_, run, joint.step_s());
      }
    }
    test::write_bench(folder_, joints);
    bench::Bench bench = bench::read_bench(folder_);
    std::ofstream rows(folder_ / "runs.csv");
    rows << fmt::format("{},arm\n", fmt::join(bench.runs.header, ","));
    for (const std::vector<std::string>& row : bench.runs.rows)
      rows << fmt::format("{},{}\n", fmt::join(row, ","), row[0].substr(0, 4));
    rows.close();
    return bench::read_bench(folder_);
  }

  static calib::JointModel healthy_with(const std::string& parameter, double value) {
    calib::JointModel model;
    model.actuator = healthy_actuator();
    calib::set(model, parameter, value);
    return model;
  }

  static std::vector<calib::JointModel> with_offsets(const calib::JointModel& joint) {
    std::vector<calib::JointModel> arms(4, joint);
    const double offsets_rad[] = {0.03, -0.03, 0.045, -0.04};
    for (std::size_t arm = 0; arm < 4; ++arm) arms[arm].actuator.sensor.zero_offset_rad = offsets_rad[arm];
    return arms;
  }
};

TEST_F(Assemblies, ThatDifferInTheirZeroHaveNoCauseInCommon) {
  const bench::Bench bench = of_arms(with_offsets(healthy_with("friction.coulomb_Nm", 0.05)));
  DiagnosedRuns runs;
  const Diagnosis found = diagnose(bench, given_healthy(), &runs);
  const std::string json = diagnosis_json(found).dump(1);
  EXPECT_TRUE(found.causes.empty()) << json;
  EXPECT_EQ(found.verdict, evidence::Verdict::kFound);
  ASSERT_EQ(found.assemblies.varies.size(), 1U) << json;
  EXPECT_EQ(found.assemblies.varies[0].parameter, "sensor.zero_offset_rad");
  EXPECT_EQ(found.assemblies.varies[0].columns, std::vector<std::string>{"arm"});
  EXPECT_LT(found.held_out_after.value, 0.7 * found.held_out_before.value);
  EXPECT_NE(json.find("\"varies_by\""), std::string::npos);
  const std::string page = diagnosis_page::page_of(bench, found, runs).html();
  EXPECT_NE(page.find("Its zero offset differs from assembly to assembly, by column arm"), std::string::npos);
  EXPECT_NE(page.find("What differs from assembly to assembly"), std::string::npos);
  EXPECT_NE(page.find("check how the arm is mounted"), std::string::npos);
}

TEST_F(Assemblies, ThatDifferDoNotHideACauseThatAllHave) {
  const bench::Bench bench = of_arms(with_offsets(healthy_with("friction.coulomb_Nm", 0.4)));
  const Diagnosis found = diagnose(bench, given_healthy());
  const std::string json = diagnosis_json(found).dump(1);
  ASSERT_EQ(found.causes.size(), 1U) << json;
  EXPECT_EQ(found.causes[0].effect, "coulomb");
  EXPECT_NEAR(found.causes[0].parameters.at(0).estimate.value, 0.4, 0.04);
  EXPECT_NE(found.assemblies.variation_of("sensor.zero_offset_rad"), nullptr) << json;
}

TEST_F(Assemblies, ThatAreAlikeChangeNothing) {
  const bench::Bench bench = of_arms(std::vector<calib::JointModel>(4, healthy_with("friction.coulomb_Nm", 0.05)));
  const Diagnosis found = diagnose(bench, given_healthy());
  EXPECT_EQ(found.verdict, evidence::Verdict::kNone);
  EXPECT_TRUE(found.assemblies.varies.empty()) << diagnosis_json(found).dump(1);
}

TEST(Differences, OfAnEffectAboutNothingAreNoCause) {
  for (const bool has_mean : {false, true}) {
    Diagnosis diagnosis;
    diagnosis.causes.resize(2);
    diagnosis.causes[0].effect = "zero_offset";
    diagnosis.causes[1].effect = "coulomb";
    diagnosis.assemblies.varies.push_back({.parameter = "sensor.zero_offset_rad", .unit = "rad", .has_mean = has_mean});
    leave_out_what_only_differs(diagnosis, {});
    EXPECT_EQ(diagnosis.causes.size(), has_mean ? 2U : 1U);
    EXPECT_EQ(diagnosis.causes.back().effect, "coulomb");
    EXPECT_EQ(diagnosis.rejected.size(), has_mean ? 0U : 1U);
  }
}

}  // namespace
}  // namespace pmg::diagnosis
