// A message of which no program knows anything but its .lcm file is exported whole: one member of each kind.
#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "pmg_planted/message_fields.hpp"
#include "topics/field_gatherer.hpp"

namespace pmg::topics {
namespace {

pmg_planted::planted_t planted() {
  pmg_planted::planted_t m{};
  m.tiny = -1;
  m.small = 2;
  m.second = 3;
  m.large = 4'000'000'000;
  m.octet = 200;
  m.single = 0.5F;
  m.wide_m = 0.1;
  m.text = "a word";
  m.flag = 1;
  m.force_N[0] = 10.5;
  m.force_N[1] = 20.5;
  m.contact[1] = 1;
  for (int i = 0; i < 3; ++i) m.raw[i] = i + 7;
  m.label[0] = "x";
  m.label[1] = "y";
  m.joint_count = 2;
  m.q_rad = {0.25, 0.75};
  m.count = 2;
  m.by = {1, 4};
  m.sample = {1.5, 2.5};
  m.word = {"b", "c"};
  m.part.height_m = 0.9;
  m.part.touches = 1;
  return m;
}

std::vector<std::pair<std::string, std::string>> exported(const std::vector<std::string>& joint_names) {
  std::vector<Field> fields;
  FieldGatherer(joint_names, fields).add(planted());
  std::vector<std::pair<std::string, std::string>> texts;
  for (const Field& field : fields) texts.emplace_back(field.path(), to_text(field.value));
  return texts;
}

TEST(PlantedMessage, EveryKindOfMemberIsExportedInTheOrderOfTheFile) {
  const std::vector<std::pair<std::string, std::string>> expected = {{"tiny", "-1"},
                                                                     {"small", "2"},
                                                                     {"second", "3"},
                                                                     {"large", "4000000000"},
                                                                     {"octet", "200"},
                                                                     {"single", "0.5"},
                                                                     {"wide_m", "0.1"},
                                                                     {"text", "a word"},
                                                                     {"flag", "1"},
                                                                     {"force_N.left", "10.5"},
                                                                     {"force_N.right", "20.5"},
                                                                     {"contact.left", "0"},
                                                                     {"contact.right", "1"},
                                                                     {"raw.0", "7"},
                                                                     {"raw.1", "8"},
                                                                     {"raw.2", "9"},
                                                                     {"label.0", "x"},
                                                                     {"label.1", "y"},
                                                                     {"q_rad.hip", "0.25"},
                                                                     {"q_rad.knee", "0.75"},
                                                                     {"by", "1;4"},
                                                                     {"sample", "1.5;2.5"},
                                                                     {"word", "b;c"},
                                                                     {"part.height_m", "0.9"},
                                                                     {"part.touches", "1"}};
  EXPECT_EQ(exported({"hip", "knee"}), expected);
}

TEST(PlantedMessage, JointsWithoutNamesAreNumbered) {
  const auto texts = exported({"hip"});
  EXPECT_EQ(texts[18].first, "q_rad.0");
  EXPECT_EQ(texts[19].first, "q_rad.1");
}

TEST(PlantedMessage, ABooleanIsAFlagAndNoNumber) {
  std::vector<Field> fields;
  FieldGatherer({}, fields).add(planted());
  for (const Field& field : fields) {
    const bool boolean = field.name == "flag" || field.name == "contact" || field.name == "part.touches";
    EXPECT_EQ(std::holds_alternative<bool>(field.value), boolean) << field.path();
    EXPECT_EQ(std::holds_alternative<double>(field.value), field.name == "single" || field.name == "wide_m" ||
                                                               field.name == "force_N" || field.name == "q_rad" ||
                                                               field.name == "part.height_m")
        << field.path();
  }
}

TEST(PlantedMessage, TheTableHoldsWhatTheFileSays) {
  using pmg_planted::planted_t;
  EXPECT_EQ(pmg_msgs::kChannel<planted_t>, "PLANTED");
  EXPECT_EQ(pmg_msgs::kChannel<pmg_planted::part_t>, "") << "it isn't sent by itself";
  EXPECT_TRUE((std::is_same_v<pmg_planted::Messages, std::tuple<planted_t>>));
  const auto& second = std::get<2>(pmg_msgs::kFields<planted_t>);
  EXPECT_EQ(second.name, "second");
  EXPECT_EQ(second.type, "int16_t");
  EXPECT_EQ(second.comment, "two in one line");
  const auto& force = std::get<9>(pmg_msgs::kFields<planted_t>);
  EXPECT_EQ(force.length, "2");
  EXPECT_EQ(force.comment, "[left, right] within [0, 1) of the weight");
  const auto& joint_count = std::get<13>(pmg_msgs::kFields<planted_t>);
  EXPECT_TRUE(joint_count.is_length);
}

}  // namespace
}  // namespace pmg::topics
