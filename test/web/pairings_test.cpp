#include "web/pairings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "seal/private_file.hpp"
#include "temporary_folder.hpp"

namespace pmg::web {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre, testing::HasSubstr, testing::Not;

class PairingsTest : public testing::Test {
 protected:
  std::string error(const std::string& name) const {
    try {
      pairings_.make(name);
      return "";
    } catch (const std::exception& exception) {
      return exception.what();
    }
  }
  const test::TemporaryFolder folder_;
  const Pairings pairings_{folder_.path() / "pairings"};
};

TEST_F(PairingsTest, ATokenIsFoundUnderItsNameUntilItIsRevoked) {
  const std::string phone = pairings_.make("phone"), headset = pairings_.make("headset");
  EXPECT_EQ(pairings_.find(phone), "phone");
  EXPECT_EQ(pairings_.find(headset), "headset");
  EXPECT_THAT(pairings_.names(), ElementsAre("headset", "phone"));
  EXPECT_TRUE(pairings_.revoke("phone"));
  EXPECT_FALSE(pairings_.revoke("phone"));
  EXPECT_EQ(pairings_.find(phone), std::nullopt);
  EXPECT_EQ(pairings_.find(headset), "headset");
  EXPECT_NE(pairings_.make("phone"), phone);
}

TEST_F(PairingsTest, NothingButTheTokenIsFound) {
  const std::string token = pairings_.make("phone");
  for (const std::string& wrong : {std::string(), std::string("phone"), token + "a", token.substr(1), "../" + token})
    EXPECT_EQ(pairings_.find(wrong), std::nullopt) << wrong;
}

TEST_F(PairingsTest, NoTwoTokensAreAlikeAndTheyHaveLettersOfAllKinds) {
  std::set<char> letters;
  std::set<std::string> tokens;
  for (int k = 0; k < 50; ++k) {
    const std::string token = pairings_.make("n" + std::to_string(k));
    tokens.insert(token);
    letters.insert(token.begin(), token.end());
  }
  EXPECT_EQ(tokens.size(), 50U);
  EXPECT_EQ(letters.size(), 32U);
}

TEST_F(PairingsTest, TheFileHasNoTokenAndIsItsOwnersAlone) {
  const std::string token = pairings_.make("phone");
  const fs::path file = folder_.path() / "pairings" / "phone.pairing";
  EXPECT_THAT(seal::read_private_file(file), Not(HasSubstr(token)));
  fs::permissions(file, fs::perms::others_read, fs::perm_options::add);
  EXPECT_EQ(pairings_.find(token), std::nullopt);
  EXPECT_EQ(pairings_.find(pairings_.make("laptop")), "laptop") << "another one's fault is not this one's";
}

TEST_F(PairingsTest, ANameThatIsTakenOrNoneIsSaid) {
  pairings_.make("phone");
  EXPECT_THAT(error("phone"), HasSubstr("revoke it first"));
  for (const char* name : {"", "../phone", "a b", "sixteen-letters-x"})
    EXPECT_THAT(error(name), HasSubstr("expected 1 to 15 letters")) << name;
  EXPECT_FALSE(pairings_.revoke("../pairings/phone"));
}

}  // namespace
}  // namespace pmg::web
