// Keys as files: one line for every fault, and nobody but the owner reads them.
#include "seal/key_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>

#include "seal/controller_seal.hpp"
#include "seal/operator_seal.hpp"

namespace pmg::seal {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class KeyFiles : public testing::Test {
 protected:
  ~KeyFiles() override { fs::remove_all(folder_); }

  static std::string error_of(const std::function<void()>& action) {
    try {
      action();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  static fs::perms rights(const fs::path& file) { return fs::status(file).permissions(); }
  fs::path write(const std::string& name, const std::string& text, unsigned mode = 0600) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / name) << text;
    ::chmod((folder_ / name).c_str(), mode);
    return folder_ / name;
  }

  fs::path folder_ = fs::temp_directory_path() / ("pmg_key_files_test_" + std::to_string(::getpid()));
  fs::path controller_ = folder_ / "controller", operator_ = folder_ / "operator";
};

TEST_F(KeyFiles, AKeyThatIsMadeFitsItsControllerAndIsReadBack) {
  EXPECT_FALSE(read_controller_keys(controller_));
  EXPECT_TRUE(read_operator_keys(operator_).empty());
  const OperatorKey anna = make_operator_key(controller_, "anna"), bert = make_operator_key(controller_, "bert");
  EXPECT_EQ(anna.controller, bert.controller);
  EXPECT_NE(anna.secret, bert.secret);
  const auto keys = read_controller_keys(controller_);
  ASSERT_TRUE(keys);
  EXPECT_EQ(Signer(keys->own).public_key(), anna.controller);
  EXPECT_EQ(keys->operators.at("anna"), anna.secret);
  fs::create_directories(operator_);
  write_operator_key(operator_ / "z1.key", anna);
  const auto read = read_operator_keys(operator_);
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].name, "anna");
  EXPECT_EQ(read[0].controller, anna.controller);
  EXPECT_EQ(read[0].secret, anna.secret);
}

TEST_F(KeyFiles, OnlyTheOwnerReadsThem) {
  const OperatorKey anna = make_operator_key(controller_, "anna");
  write_operator_key(controller_ / "given.key", anna);
  constexpr auto kOwner = fs::perms::owner_read | fs::perms::owner_write;
  for (const char* file : {"controller.key", "operators/anna.key", "given.key"}) {
    EXPECT_EQ(rights(controller_ / file), kOwner) << file;
  }
  EXPECT_EQ(rights(controller_), kOwner | fs::perms::owner_exec);
  ::chmod((controller_ / "operators/anna.key").c_str(), 0640);
  EXPECT_THAT(error_of([&] { read_controller_keys(controller_); }),
              AllOf(HasSubstr("anna.key"), HasSubstr("chmod 600"), Not(HasSubstr("\n"))));
}

TEST_F(KeyFiles, AFileThatCannotBeWrittenIsNamedAndLeavesNothingBehind) {
  const OperatorKey anna = make_operator_key(controller_, "anna");
  EXPECT_THAT(error_of([&] { write_operator_key(folder_ / "nowhere/z1.key", anna); }), HasSubstr("nowhere/z1.key: No"));
  write_operator_key(folder_ / "z1.key", anna);
  EXPECT_THAT(error_of([&] { write_operator_key(folder_ / "z1.key", anna); }), HasSubstr("z1.key: File exists"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2)
      << "z1.key, and the controller's";
}

TEST_F(KeyFiles, AFolderThatIsThereKeepsItsRights) {
  fs::create_directories(controller_);
  ::chmod(controller_.c_str(), 0755);
  make_operator_key(controller_, "anna");
  EXPECT_EQ(rights(controller_), static_cast<fs::perms>(0755));
  EXPECT_EQ(rights(controller_ / "controller.key"), static_cast<fs::perms>(0600));
}

TEST_F(KeyFiles, ARevokedKeyIsGoneAndASecondOneIsNew) {
  const OperatorKey first = make_operator_key(controller_, "anna");
  EXPECT_THAT(error_of([&] { make_operator_key(controller_, "anna"); }), HasSubstr("revoke it first"));
  EXPECT_TRUE(revoke_operator_key(controller_, "anna"));
  EXPECT_FALSE(revoke_operator_key(controller_, "anna"));
  EXPECT_TRUE(read_controller_keys(controller_)->operators.empty());
  EXPECT_NE(make_operator_key(controller_, "anna").secret, first.secret);
}

TEST_F(KeyFiles, AControllerThatLooksAgainTakesKeysThatWereMadeOrRevokedIntoAccount) {
  make_operator_key(controller_, "anna");
  ControllerSeal seal = load_controller_seal(controller_.string(), "memq://", false);
  EXPECT_EQ(seal.refresh(), "") << "what it began with";
  make_operator_key(controller_, "bert");
  EXPECT_EQ(seal.refresh(), "operators with a key: 2");
  EXPECT_EQ(seal.refresh(), "");
  revoke_operator_key(controller_, "anna");
  EXPECT_EQ(seal.refresh(), "operators with a key: 1");
  ::chmod((controller_ / "controller.key").c_str(), 0644);
  EXPECT_THAT(seal.refresh(), HasSubstr("from now on nobody has a key"));
}

TEST_F(KeyFiles, AControllerSeesAtOnceThatAKeyFileIsDamagedOrReadByOthers) {
  make_operator_key(controller_, "anna");
  ControllerSeal seal = load_controller_seal(controller_.string(), "memq://", false);
  const fs::path file = controller_ / "operators/anna.key";
  const auto folder_time = fs::last_write_time(controller_ / "operators");
  const auto size = fs::file_size(file);
  ::chmod(file.c_str(), 0640);
  EXPECT_THAT(seal.refresh(), AllOf(HasSubstr("chmod 600"), HasSubstr("from now on nobody has a key")));
  EXPECT_EQ(seal.refresh(), "") << "said once";
  ::chmod(file.c_str(), 0600);
  EXPECT_EQ(seal.refresh(), "operators with a key: 1");
  fs::resize_file(file, size - 10);
  EXPECT_THAT(seal.refresh(), AllOf(HasSubstr("anna.key"), HasSubstr("from now on nobody has a key")));
  EXPECT_EQ(fs::last_write_time(controller_ / "operators"), folder_time) << "the folder shows nothing of all this";
}

TEST_F(KeyFiles, WithKeysThatWereAskedForNothingUnsignedIsBelieved) {
  fs::create_directories(operator_);
  write_operator_key(operator_ / "z1.key", make_operator_key(controller_, "anna"));
  const auto believes_unsigned = [](const std::string& folder, const char* url) {
    return load_operator_seal(folder, url).believe("STATUS", {}, std::nullopt, 0).has_value();
  };
  for (const char* url : {"udpm://239.255.76.67:7667?ttl=0", "udpm://239.255.76.67:7667?ttl=1"}) {
    EXPECT_FALSE(believes_unsigned(operator_.string(), url)) << url;
  }
  ::setenv("XDG_CONFIG_HOME", folder_.c_str(), 1);
  EXPECT_TRUE(believes_unsigned("", "udpm://239.255.76.67:7667?ttl=1")) << "who has no keys";
  fs::create_directories(folder_ / "pmg");
  fs::rename(operator_, folder_ / "pmg" / "operator-keys");
  EXPECT_TRUE(believes_unsigned("", "udpm://239.255.76.67:7667?ttl=0")) << "keys that are only there, on this computer";
  EXPECT_FALSE(believes_unsigned("", "udpm://239.255.76.67:7667?ttl=1"));
  ::unsetenv("XDG_CONFIG_HOME");
}

TEST_F(KeyFiles, NamesStayInTheFolder) {
  for (const char* name : {"", "../anna", "a/b", ".anna", "anna\n", "a name", "anna.b", "a-name-of-16-let"}) {
    EXPECT_THAT(error_of([&] { make_operator_key(controller_, name); }), HasSubstr("expected 1 to 15 letters")) << name;
    EXPECT_FALSE(revoke_operator_key(controller_, name)) << name;
  }
}

TEST_F(KeyFiles, AFolderIsOfOneOperatorAndAFileOfAName) {
  fs::create_directories(operator_);
  write_operator_key(operator_ / "z1.key", make_operator_key(controller_, "anna"));
  write_operator_key(operator_ / "z2.key", make_operator_key(folder_ / "other", "anna"));
  EXPECT_EQ(read_operator_keys(operator_).size(), 2u) << "of two controllers";
  write_operator_key(operator_ / "z3.key", make_operator_key(controller_, "bob"));
  EXPECT_THAT(error_of([&] { read_operator_keys(operator_); }),
              AllOf(HasSubstr("z3.key"), HasSubstr("bob"), HasSubstr("anna"), Not(HasSubstr("\n"))));
  fs::rename(controller_ / "operators/bob.key", controller_ / "operators/anna.bob.key");
  EXPECT_THAT(error_of([&] { read_controller_keys(controller_); }), HasSubstr("anna.bob.key"));
}

TEST_F(KeyFiles, WhatIsNoKeyIsSaidInOneLineWithItsFile) {
  const std::string digits(64, 'a');
  const auto key = [&](const char* name, const std::string& secret_line) {
    std::string text = "pmg operator key 1\noperator: ";
    text.append(name).append("\ncontroller: ").append(digits).append("\n").append(secret_line).append("\n");
    return text;
  };
  for (const auto& [text, complaint] : {
           std::pair{std::string(), std::string("begins with \"pmg operator key 1\"")},
           std::pair{std::string(100'000, 'x'), std::string("begins with")},
           std::pair{std::string("pmg operator key 1\n"), std::string("begins with")},
           std::pair{key("anna", ""), std::string("\"secret: \"")},
           std::pair{key("anna", "secret: b" + digits), std::string("64 hexadecimal digits")},
           std::pair{key("anna", "secret: g" + digits.substr(1)), std::string("64 hexadecimal digits")},
           std::pair{key("a/b", "secret: " + digits), std::string("\"operator: \" and a name")},
       }) {
    write("bad.key", text);
    EXPECT_THAT(error_of([&] { read_operator_keys(folder_); }),
                AllOf(HasSubstr(complaint), HasSubstr("bad.key"), Not(HasSubstr("\n"))));
  }
}

TEST_F(KeyFiles, ADeviceAFifoOrALinkIsNoKey) {
  fs::create_directories(folder_);
  const fs::path file = folder_ / "x.key";
  fs::create_symlink("/dev/zero", file);
  EXPECT_THAT(error_of([&] { read_operator_keys(folder_); }), HasSubstr("x.key"));
  fs::remove(file);
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  EXPECT_THAT(error_of([&] { read_operator_keys(folder_); }), HasSubstr("expected a file"));
}

TEST(KeyFolders, AreBelowTheUsersConfiguration) {
  ::setenv("XDG_CONFIG_HOME", "/somewhere", 1);
  EXPECT_EQ(controller_folder(), "/somewhere/pmg/controller-keys");
  ::unsetenv("XDG_CONFIG_HOME");
  ::setenv("HOME", "/home/anna", 1);
  EXPECT_EQ(operator_folder(), "/home/anna/.config/pmg/operator-keys");
}

}  // namespace
}  // namespace pmg::seal
