#include "clips_report.hpp"

#include <fmt/format.h>

#include "library_page/library_page.hpp"
#include "model/clip_library_file.hpp"
#include "model/robot_model.hpp"
#include "model/standing_posture.hpp"
#include "retargeting/library_review.hpp"
#include "shown_progress.hpp"
#ifdef PMG_SIL
#include "library_film/clip_player.hpp"
#include "library_film/library_film.hpp"
#include "sim/video_writer.hpp"
#endif

namespace pmg::apps {
namespace {

CLI::App* add(CLI::App& app, ReportOptions& options, const char* name, const char* what, const char* out) {
  CLI::App* command = app.add_subcommand(name, what);
  command->add_option("clips", options.clips, "directory of the clips")->required();
  command->add_option("--recipe", options.recipe, "the LIBRARY.yaml that they were made from")->required();
  command->add_option("--recordings", options.recordings, "folder of its recordings; the recipe's own if left out");
  command->add_option("--robot", options.robot, "robot's name, or its directory")->capture_default_str();
  command->add_option(std::string(name) == "report" ? "--out" : "--video", options.out, out)->required();
  return command;
}

struct Reviewed {
  model::RobotModel robot;
  retargeting::LibraryReview review;
};

Reviewed reviewed(const ReportOptions& options, ProgressLine& progress) {
  model::RobotModel robot = model::load_robot_standing_as(options.robot, options.clips);
  const ClipLibrary library = model::load_clip_library(options.clips, robot);
  retargeting::LibraryReview review =
      retargeting::review(robot, library, retargeting::read_library_recipe(options.recipe, options.recordings),
                          shown(progress, "comparing with the person"));
  return {std::move(robot), std::move(review)};
}

}  // namespace

CLI::App* add_report(CLI::App& app, ReportOptions& options) {
  return add(app, options, "report",
             "Show a library of a recorded person as a page: person and robot, every figure and its limit",
             "file for the page (HTML)");
}

int report(const ReportOptions& options) {
  pages::expect_page_or_none(options.out);
  ProgressLine progress;
  const Reviewed of = reviewed(options, progress);
  library_page::Measured measured;
#ifdef PMG_SIL
  library_film::ClipPlayer player(of.robot);
  for (const retargeting::ReviewedClip& clip : of.review.clips) {
    const library_film::Touch touch = player.self_collision(clip.clip);
    measured.self_collision[clip.recipe.name] = {touch.depth_m, touch.links};
  }
#endif
  progress.clear();
  library_page::page_of(of.review, measured).write(options.out);
  const work::Worth worth = worth_of(of.review, measured);
  fmt::print("{}\npage in {}\n", worth.usable() ? "every figure is as asked" : worth.sentence(), options.out.string());
  return worth.exit_code();
}

#ifdef PMG_SIL
CLI::App* add_preview(CLI::App& app, ReportOptions& options) {
  return add(app, options, "preview", "Film a library of a recorded person: robot beside person, kinematically",
             "file for the film (mp4); needs ffmpeg and OSMesa");
}

int preview(const ReportOptions& options) {
  sim::expect_ffmpeg();
  ProgressLine progress;
  const Reviewed of = reviewed(options, progress);
  library_film::write_film(of.robot, of.review, options.out, 6.0, shown(progress));
  progress.clear();
  fmt::print("film in {}\n", options.out.string());
  return 0;
}
#else
CLI::App* add_preview(CLI::App&, ReportOptions&) { return nullptr; }
int preview(const ReportOptions&) { return 2; }
#endif

}  // namespace pmg::apps
