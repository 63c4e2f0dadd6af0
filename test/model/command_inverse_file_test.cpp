#include "model/command_inverse_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/config_error.hpp"
#include "folders.hpp"
#include "model/bundle.hpp"
#include "model/clip_library_file.hpp"
#include "refusal.hpp"
#include "temporary_copy.hpp"

namespace pmg::model {
namespace {

using ::testing::HasSubstr;

constexpr const char* kHeader =
    "vx_m_s,vy_m_s,omega_rad_s,height_m,correction_vx_m_s,correction_vy_m_s,correction_omega_rad_s,correction_height_"
    "m\n";

class CommandInverseFile : public testing::Test {
 protected:
  std::string refusal() const {
    return test::refusal_by<files::ConfigError>([&] { load_clip_library(copy_.file("clips"), robot_); });
  }

  const std::string biped_ = pmg::test::project_folder() + "/test/data/robots/biped";
  RobotModel robot_ = load_robot(biped_);
  TemporaryCopy copy_{biped_};
};

TEST_F(CommandInverseFile, IsReadAsWrittenAndBelongsToTheLibrary) {
  const std::string without = clip_library_sha256(copy_.file("clips"));
  const CommandInverse written({std::vector<double>{-0.1, 0.3}, {0.0}, {0.0}, {-1.0 / 3.0, 0.0}},
                               {{0.1, 0.0, 1e-17, -2.0 / 3.0}, {}, {0.0, 5.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}});
  write_command_inverse(copy_.file("clips"), written);
  const CommandInverse read = load_clip_library(copy_.file("clips"), robot_).inverse;
  EXPECT_EQ(read.axis(), written.axis());
  EXPECT_EQ(read.correction(), written.correction());
  EXPECT_NE(clip_library_sha256(copy_.file("clips")), without);
}

TEST_F(CommandInverseFile, WithoutOneTheCommandStaysAsItIs) {
  EXPECT_TRUE(load_clip_library(copy_.file("clips"), robot_).inverse.empty());
}

TEST_F(CommandInverseFile, RefusesAGridWithAHole) {
  copy_.write("clips/inverse.csv", std::string(kHeader) + "0,0,0,0,0,0,0,0\n0,1,0,0,0,0,0,0\n1,0,0,0,0,0,0,0\n");
  EXPECT_THAT(refusal(), HasSubstr("inverse.csv: has 3 rows; expected one for every combination of its commands"));
}

TEST_F(CommandInverseFile, RefusesAnUnsortedGrid) {
  copy_.write("clips/inverse.csv", std::string(kHeader) + "1,0,0,0,0,0,0,0\n0,0,0,0,0,0,0,0\n");
  EXPECT_THAT(refusal(), HasSubstr("inverse.csv:2: vx_m_s: is 1; expected 0: the full grid, sorted"));
}

TEST_F(CommandInverseFile, RefusesWhatIsntANumber) {
  copy_.write("clips/inverse.csv", std::string(kHeader) + "0,0,0,0,0,0,nan,0\n");
  EXPECT_THAT(refusal(), HasSubstr("inverse.csv:2:13: correction_omega_rad_s: is 'nan'; expected a finite number"));
}

TEST_F(CommandInverseFile, RefusesAnEmptyTable) {
  copy_.write("clips/inverse.csv", kHeader);
  EXPECT_THAT(refusal(), HasSubstr("inverse.csv: has 0 rows; expected one for every combination"));
}

}  // namespace
}  // namespace pmg::model
