#include "evidence/bench_options.hpp"

namespace pmg::evidence {

std::vector<Option> listed(const bench::OddRunOptions& o) {
  const char* servo = "240 conditions of a measured servo: odd runs 11 times and more, all others up to 3";
  const char* assumed = "assumed";
  return {
      {"times_usual", o.times_usual, "",
       "repeats that differ by so many times what repeats usually do disagree; noise alone differs by two or three",
       servo},
      {"fewest_conditions", o.fewest_conditions, "", "conditions that say what is usual: a median of fewer is none",
       assumed},
      {"times_nearer", o.times_nearer, "",
       "of two repeats another condition is nearer to one, where the other's distance is so many times as large",
       assumed},
      {"agreeing_share", o.agreeing_share, "", "share of the other conditions that must be nearer to the same one",
       assumed},
      {"slow_share", o.slow_share, "",
       "a difference whose half-second means hold a smaller share of its squares oscillates: noise, or a drive that "
       "hunts",
       assumed},
      {"fast_ratio", o.fast_ratio, "",
       "and both repeats move about as much: a joint that stalls in a fast motion moves less", assumed},
      {"times_by_chance", o.times_by_chance, "",
       "repeats of a drive that hunts may be in step by chance, but hardly to so many times the usual difference",
       assumed},
      {"times_neighbours", o.times_neighbours, "",
       "a run without repeats is odd from so many times the usual distance to neighbours on: the edge of a design "
       "has two or three times the distance",
       assumed}};
}

std::vector<Option> listed(const calib::StepOptions& o) {
  return {{"share_of_noise", o.share_of_noise, "",
           "an integration error of this share of residual or noise adds a quarter to its mean square; a residual "
           "counts as unexplained from several times the noise's on",
           "arithmetic"},
          {"finest_share", o.finest_share, "", "of the first step: three halvings, eight times the time of a rollout",
           "time of a diagnosis"},
          {"most_steps", o.most_steps, "",
           "steps of all searched runs together: a finer step than this takes counts into the noise floor instead",
           "time of a diagnosis"}};
}

}  // namespace pmg::evidence
