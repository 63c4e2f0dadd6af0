// The promises of the reader of force plates.
#include "mocap_files/force_plates.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "files/config_error.hpp"
#include "temporary_folder.hpp"

namespace pmg::mocap {
namespace {

class ForcePlatesFile : public ::testing::Test {
 protected:
  ForcePlates read(const std::string& text) {
    std::ofstream(file_) << text;
    return read_force_plates(file_);
  }
  void expect_refused(const std::string& text, const std::string& words) {
    try {
      read(text);
      FAIL() << "no error: " << text;
    } catch (const files::ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }
  pmg::test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.file("plates.mot");
};
const std::string kNames = "a walk\nnRows=5\nendheader\ntime\tground_force_l_vy ground_force_r_vx ground_force_r_vy\n";

TEST_F(ForcePlatesFile, SaysWhenEachFootCarriesAndTakesItsOwnEndsForNoEvents) {
  const ForcePlates plates = read(kNames + "0 500 1 0\n0.1 30 1 10\n0.2 5 99 25\n0.3 0 1 800\n0.4 21 1 700\n");
  EXPECT_EQ(plates.from_s, 0.0);
  EXPECT_EQ(plates.to_s, 0.4);
  ASSERT_EQ(plates.contacts[0].size(), 2U);
  EXPECT_FALSE(plates.contacts[0][0].contact_s.has_value());
  EXPECT_EQ(plates.contacts[0][0].off_s, 0.2);
  EXPECT_EQ(plates.contacts[0][1].contact_s, 0.4);
  ASSERT_EQ(plates.contacts[1].size(), 1U);
  EXPECT_EQ(plates.contacts[1][0].contact_s, 0.2);
  EXPECT_FALSE(plates.contacts[1][0].off_s.has_value());
}

TEST_F(ForcePlatesFile, IsRefusedWithTheLineWhereItIsBroken) {
  expect_refused("time ground_force_l_vy ground_force_r_vy\n0 1 2\n", "endheader");
  expect_refused("endheader\n", "endheader");
  expect_refused(kNames, "has no rows");
  expect_refused("endheader\ntime ground_force_l_vy\n0 1\n", "has no column ground_force_r_vy");
  expect_refused(kNames + "0 500 1 0\n0.1 30 one 10\n", "plates.mot:6:");
  expect_refused(kNames + "0 500 1 0\n0.1 30\n", "the file ends here");
  expect_refused(kNames + "0 500 1 0\n0.1 30\n0.2 30 1 10\n", "plates.mot:7: a row has not 4 numbers");
  expect_refused(kNames + "0 500 1 0 7\n0.1 30 1 10\n", "plates.mot:5: a row has not 4 numbers");
  expect_refused(kNames + "0.1 500 1 0\n0.1 30 1 10\n", "doesn't increase");
}

}  // namespace
}  // namespace pmg::mocap
