#include "web/certificate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "temporary_folder.hpp"

namespace pmg::web {
namespace {

namespace fs = std::filesystem;
using testing::AllOf, testing::HasSubstr, testing::Not;

constexpr std::int64_t kNow_s = 1'764'000'000, kDay_s = 86400;
const std::array<std::string, 2> kMadeFor = {"localhost", "192.168.1.7"};

class CertificateTest : public testing::Test {
 protected:
  std::string error() const {
    try {
      load_certificate(folder_.path(), kMadeFor, kNow_s);
      return "";
    } catch (const std::exception& exception) {
      return exception.what();
    }
  }
  const test::TemporaryFolder folder_;
};

TEST_F(CertificateTest, IsMadeOnceAndKept) {
  const Certificate first = load_certificate(folder_.path(), kMadeFor, kNow_s);
  EXPECT_THAT(first.fingerprint, testing::MatchesRegex("([0-9A-F][0-9A-F]:)+[0-9A-F][0-9A-F]"));
  EXPECT_EQ(first.fingerprint.size(), 32U * 3 - 1);
  EXPECT_EQ(load_certificate(folder_.path(), kMadeFor, kNow_s + (kCertificateDays - 40) * kDay_s).fingerprint,
            first.fingerprint);
  EXPECT_EQ(fs::status(folder_.file("server.pem")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(CertificateTest, IsMadeAnewBeforeItEnds) {
  const Certificate first = load_certificate(folder_.path(), kMadeFor, kNow_s);
  const Certificate second = load_certificate(folder_.path(), kMadeFor, kNow_s + (kCertificateDays - 20) * kDay_s);
  EXPECT_NE(second.fingerprint, first.fingerprint);
}

TEST_F(CertificateTest, AFileThatOthersMayReadOrThatIsNoneIsRefusedInOneLine) {
  load_certificate(folder_.path(), kMadeFor, kNow_s);
  fs::permissions(folder_.file("server.pem"), fs::perms::group_read, fs::perm_options::add);
  EXPECT_THAT(error(), AllOf(HasSubstr("server.pem"), HasSubstr("chmod 600"), Not(HasSubstr("\n"))));
  fs::permissions(folder_.file("server.pem"), fs::perms::group_read, fs::perm_options::remove);
  std::ofstream(folder_.file("server.pem")) << "something else\n";
  EXPECT_THAT(error(), AllOf(HasSubstr("server.pem"), HasSubstr("remove the file"), Not(HasSubstr("\n"))));
}

}  // namespace
}  // namespace pmg::web
