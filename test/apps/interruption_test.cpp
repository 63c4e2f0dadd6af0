// Ctrl-C in the middle of long work, typed as by a user: finished work is kept and can be read back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/interrupted_program.hpp"
#include "apps/running_program.hpp"
#include "folders.hpp"
#include "io/log_reader.hpp"
#include "temporary_folder.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr int kInterrupted = 130;
constexpr double kPromised_s = 1.0;  ///< from Ctrl-C to the end, on an idle processor

class Interruption : public testing::Test {
 protected:
  Interruption() { fs::create_directories(folder_); }

  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  std::string scenario(double seconds) const {
    std::ofstream(folder_ / "scenario.yaml")
        << "name: long\nsteps:\n  - {for_s: " << seconds << ", text: stand still, mode: stand}\n";
    return at("scenario.yaml");
  }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(test::text_of(folder_ / name)); }
  /// Number of frames that a player decodes; -1 if it isn't playable.
  int frames(const std::string& film) const {
    const std::string command = "ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 '" +
                                at(film) + "' > '" + at("frames") + "' 2>&1";
    if (std::system(command.c_str()) != 0) return -1;
    return std::atoi(test::text_of(folder_ / "frames").c_str());
  }

  const test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.file("an interruption");
};

TEST_F(Interruption, AFilmUntilCtrlCIsWholeAndTheRunIsKept) {
  test::PseudoTerminal sil("pmg_sil",
                           {"--policy", "none", "--scenario", scenario(600.0), "--out", at("run"), "--video"});
  const fs::path log = folder_ / "run" / "log.lcm";
  // A quarter of a megabyte is about a second, which has more frames than the encoder holds back.
  ASSERT_TRUE(test::until(sil, [&] { return fs::exists(log) && fs::file_size(log) > 250'000; })) << sil.text();
  const test::Ended ended = test::interrupt(sil);
  EXPECT_EQ(ended.exit_code, kInterrupted) << sil.text();
  const auto summary = json("run/summary.json");
  EXPECT_EQ(summary["interrupted"], true);
  EXPECT_FALSE(summary.contains("film_failure")) << summary["film_failure"];
  const double duration_s = summary["duration_s"].get<double>();
  EXPECT_LT(duration_s, 600.0);
  EXPECT_EQ(frames("run/video.mp4"), static_cast<int>(std::floor(duration_s * 25.0 + 1e-6)))
      << "25 a second, to the last";
  int ticks = 0;
  io::LogReader reader(log);
  while (reader.next()) ticks += reader.channel() == "TICK" ? 1 : 0;
  EXPECT_EQ(ticks, static_cast<int>(std::lround(duration_s * 100.0)));
}

/// A program in long work, and its terminal output at that time.
struct LongWork {
  const char* name;
  const char* program;
  std::vector<std::string> arguments;
  const char* shows;
  int signal = SIGINT;
};

class LongWorkTest : public Interruption, public testing::WithParamInterface<LongWork> {};

TEST_P(LongWorkTest, EndsWithinASecond) {
  std::vector<std::string> arguments = GetParam().arguments;
  for (std::string& argument : arguments) {
    if (argument == "OUT") argument = at("out");
  }
  test::PseudoTerminal program(GetParam().program, arguments);
  ASSERT_TRUE(test::wrote(program, GetParam().shows)) << program.text();
  const test::Ended ended = test::interrupt(program, GetParam().signal);
  EXPECT_EQ(ended.exit_code, kInterrupted) << program.text();
  EXPECT_LT(ended.cpu_after_s, kPromised_s);
}

INSTANTIATE_TEST_SUITE_P(
    Programs, LongWorkTest,
    testing::Values(LongWork{"SilOnSigterm",
                             "pmg_sil",
                             {"--policy", "none", "--scenario", "config/scenarios/tour.yaml", "--out", "OUT"},
                             "/ ",
                             SIGTERM},
                    LongWork{"ClipsSynth", "pmg_clips", {"synth", "--out", "OUT"}, "making forward"},
                    LongWork{"ClipsSynthOnSigterm", "pmg_clips", {"synth", "--out", "OUT"}, "making forward", SIGTERM},
                    LongWork{"EvalPushOnSigterm",
                             "pmg_eval",
                             {"push", "--strengths", "0", "--trials", "400", "--jobs", "1", "--out", "OUT"},
                             "s left",
                             SIGTERM},
                    LongWork{"DiagnoseRecord", "pmg_diagnose", {"--robot", "z1", "--record", "OUT"}, "excitation"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST_F(Interruption, ClipsThatWereThereStayWhole) {
  fs::copy("config/robots/z1/clips", folder_ / "clips");
  const auto contents = [&] {
    std::string all;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder_ / "clips")) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) all += file.filename().string() + "\n" + test::text_of(file);
    return all;
  };
  const std::string before = contents();
  test::PseudoTerminal clips("pmg_clips", {"synth", "--out", at("clips")});
  ASSERT_TRUE(test::wrote(clips, "making forward"));
  EXPECT_EQ(test::interrupt(clips).exit_code, kInterrupted);
  EXPECT_EQ(contents(), before);

  test::PseudoTerminal invert("pmg_clips", {"invert", "--clips", at("clips")});
  ASSERT_TRUE(test::wrote(invert, "inverting"));
  EXPECT_EQ(test::interrupt(invert).exit_code, kInterrupted);
  EXPECT_EQ(contents(), before);
}

TEST_F(Interruption, AnEvaluationKeepsWhatIsComplete) {
  test::PseudoTerminal eval("pmg_eval",
                            {"push", "--strengths", "0", "--trials", "400", "--jobs", "1", "--out", at("push")});
  ASSERT_TRUE(test::wrote(eval, "s left"));  // the first trial is over
  const test::Ended ended = test::interrupt(eval);
  EXPECT_EQ(ended.exit_code, kInterrupted) << eval.text();
  EXPECT_LT(ended.cpu_after_s, kPromised_s);
  EXPECT_TRUE(fs::exists(folder_ / "push" / "report.html"));
  EXPECT_EQ(json("push/push.json")["complete"], false);
}

/// A replacement of ffmpeg, found before the real one.
class FilmTrouble : public Interruption {
 protected:
  /// pmg_sil for two seconds of standing, with this shell script as ffmpeg; empty: without ffmpeg.
  int film(const std::string& script) {
    const fs::path programs = folder_ / "programs";
    fs::create_directories(programs);
    if (!script.empty()) {
      std::ofstream(programs / "ffmpeg") << "#!/bin/sh\n" << script;
      fs::permissions(programs / "ffmpeg", fs::perms::owner_all);
    }
    const std::string command =
        "PATH='" + programs.string() + "' '" + pmg::test::program_folder() + "/pmg_sil' --policy none --scenario '" +
        scenario(2.0) + "' --video --overwrite --out '" + at("run") + "' > '" + at("out") + "' 2> '" + at("err") + "'";
    const int status = std::system(command.c_str());
    err_ = test::text_of(folder_ / "err");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string err_;
};

TEST_F(FilmTrouble, WithoutFfmpegThatIsSaidBeforeAnythingIsWritten) {
  fs::create_directories(folder_ / "run");
  std::ofstream(folder_ / "run" / "log.lcm") << "of an earlier run";
  EXPECT_EQ(film(""), 2);
  EXPECT_THAT(err_, AllOf(HasSubstr("pmg_sil: video: ffmpeg doesn't start"), HasSubstr("install ffmpeg")));
  EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
  EXPECT_EQ(test::text_of(folder_ / "run" / "log.lcm"), "of an earlier run");
}

TEST_F(FilmTrouble, AnFfmpegThatDiesCostsTheFilmAlone) {
  EXPECT_EQ(film("case \"$*\" in *-version*) exit 0;; esac\necho 'No space left on device' >&2\nexit 1\n"), 2);
  EXPECT_THAT(err_, AllOf(HasSubstr("pmg_sil: video: ffmpeg stopped while writing"), HasSubstr("video.mp4"),
                          HasSubstr("(No space left on device)"), HasSubstr("the run goes on without a film")));
  EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
  const auto summary = json("run/summary.json");
  EXPECT_NEAR(summary["duration_s"].get<double>(), 2.0, 1e-9) << "to its end";
  EXPECT_THAT(summary["film_failure"].get<std::string>(), HasSubstr("No space left"));
  EXPECT_EQ(summary["fell"], false);
}

}  // namespace
}  // namespace pmg
