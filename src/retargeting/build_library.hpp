// A clip library from a recipe and its recordings.
#pragma once

#include <string>
#include <vector>

#include "mocap/gait_cycle.hpp"
#include "mocap_files/key_bodies.hpp"
#include "mocap_files/recording.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"
#include "retargeting/library_recipe.hpp"
#include "retargeting/retargeting.hpp"
#include "work/progress.hpp"

namespace pmg::retargeting {

struct BuiltClip {
  ClipRecipe recipe;
  RetargetedClip made;
  std::string source;              ///< one line for the clip's YAML
  std::vector<std::string> notes;  ///< what the reader of the recording guessed
};

struct BuiltLibrary {
  ClipLibrary library;  ///< without inverse
  std::vector<BuiltClip> clips;
};

/// The cycle with the least loop error of the recipe's frames; for `auto`, of the stretches that
/// mocap::find_activities holds for this primitive. Throws files::ConfigError at the recipe's line if there is none.
mocap::GaitCycle chosen_cycle(const ClipRecipe& recipe, const mocap::Recording& recording);

/// A clip's recording, and the cycle that is cut from it.
struct Source {
  mocap::Recording recording;
  mocap::GaitCycle cut;
};
/// Throws files::ConfigError as build_library.
Source read_source(const ClipRecipe& recipe, const mocap::NameTable& names);
/// The recipe's table of names, or the default one. Throws files::ConfigError.
mocap::NameTable names_of(const LibraryRecipe& recipe);

/// Clips are made on all cores; the result doesn't depend on how many. The library's velocity scale is the clips' own
/// speed. Throws files::ConfigError for a recording that can't be read, has no cycle, moves in
/// another direction than the clip's, or whose clip leaves the joints' limits; work::Interrupted where progress is
/// over.
BuiltLibrary build_library(const model::RobotModel& robot, const LibraryRecipe& recipe,
                           const work::Progress& progress = {});

}  // namespace pmg::retargeting
