// A library of recorded people against what it is asked for.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pages/pictures.hpp"
#include "retargeting/library_review.hpp"
#include "work/worth.hpp"

namespace pmg::library_page {

/// What a simulation's collision shapes say of a clip.
struct SelfCollision {
  double depth_m = 0.0;  ///< of two links into each other, largest over the cycle; 0: they stay apart
  std::string links;     ///< the two
};

/// What a review can't measure by itself. An entry that is missing was not measured, and nothing says that it holds.
struct Measured {
  std::map<std::string, SelfCollision> self_collision;  ///< by the clip's name
};

/// A figure beside its limit, and one word for it.
struct Judged {
  std::string word;
  pages::Judgement shown;
};

/// Every figure of a clip; "not measured" is partial.
std::vector<Judged> judge(const retargeting::ReviewedClip& clip, const Measured& measured,
                          const retargeting::ClipGoals& goals = {});

/// What misses its limit, and what was not measured, clip by clip; and the length of all clips together.
work::Worth worth_of(const retargeting::LibraryReview& review, const Measured& measured,
                     const retargeting::ClipGoals& goals = {});

}  // namespace pmg::library_page
