#include "data_faults/options.hpp"

namespace pmg::data_faults {

std::vector<evidence::Option> listed(const DataFaultOptions& o) {
  const char* plants = "hidden plants, seeds 100 to 179";
  const char* literature = "hidden plants of the literature, even seeds 0 to 638";
  const char* assumed = "assumed";
  return {
      {"sure_correlation", o.sure_correlation, "",
       "two columns of which one follows from the other, as a speed from readings, are compared if they correlate so "
       "well",
       assumed},
      {"follows_correlation", o.follows_correlation, "",
       "readings follow their commands if they correlate so well at the best lag", assumed},
      {"same_kind_share", o.same_kind_share, "", "a fault is one of all runs if this share of them shows it", assumed},
      {"unit_tolerance", o.unit_tolerance, "", "logarithm by which a factor may miss a unit's or a firmware's",
       assumed},
      {"strange_factor", o.strange_factor, "",
       "a factor between two columns beyond it is another unit, though nobody knows which", assumed},
      {"slope_tolerance", o.slope_tolerance, "",
       "readings move by a unit's factor of their commands if they do so within this factor: a weak drive doesn't "
       "reach "
       "its commands",
       assumed},
      {"sensor_lag_s", o.sensor_lag_s, "s", "a recorded speed may be so late: drives filter it", assumed},
      {"shift_samples", o.shift_samples, "", "samples by which a column must be early or late", assumed},
      {"least_shift_s", o.least_shift_s, "s", "and the time", plants},
      {"shift_rest", o.shift_rest, "",
       "a shift between two columns counts if at most this share of what they don't explain of each other is left",
       assumed},
      {"longest_shift_s", o.longest_shift_s, "s", "shifts are looked for up to it", assumed},
      {"law_factor", o.law_factor, "",
       "strange_factor of a recorded torque or voltage against the drive's law: gains are off by less", assumed},
      {"command_difference", o.command_difference, "",
       "two recordings have the same commands if these differ by at most this share of their size", assumed},
      {"clear_gain", o.clear_gain, "",
       "a sign, a unit or a row of one run is wrong if the correction divides the model's error by so much", plants},
      {"overwhelming_gain", o.overwhelming_gain, "", "and if it divides it by so much", "random benches"},
      {"usual_error", o.usual_error, "", "or if the error then is at most so many times the median over the runs",
       plants},
      {"usual_deviations", o.usual_deviations, "", "or within so many deviations of it", plants},
      {"largest_usual_error", o.largest_usual_error, "", "which count up to so many times the median", plants},
      {"column_gain", o.column_gain, "", "clear_gain of a column of all runs", plants},
      {"model_shift_samples", o.model_shift_samples, "",
       "samples by which readings must be early or late of the model: one may be lost between two clocks", literature},
      {"shift_gain", o.shift_gain, "", "clear_gain of a run's shift", plants},
      {"lone_shift_gain", o.lone_shift_gain, "", "the same of a run that has no repeat: fast motion lags, too",
       "random benches"},
      {"longest_delay_s", o.longest_delay_s, "s", "a drive's delay is shorter", assumed},
      {"row_gain", o.row_gain, "",
       "two rows stand for each other if exchanging them divides both errors by so much, in "
       "the geometric mean",
       plants},
      {"pair_gain", o.pair_gain, "", "and each by so much", plants},
      {"least_mass_factor", o.least_mass_factor, "", "a load's mass is wrong from this factor on", assumed},
      {"mass_gain", o.mass_gain, "", "and if its correction divides the error on the load's runs by so much", plants},
      {"least_gain_factor", o.least_gain_factor, "", "a gain acts by another factor from this one on", plants},
      {"gain_gain", o.gain_gain, "", "and if its correction divides the error on the gain's runs by so much", plants},
      {"damping_gain", o.damping_gain, "", "the same of kd: friction, lags and speed limits look like damping", plants},
      {"least_common_gain", o.least_common_gain, "",
       "all gains act by another factor from this one on: less is the effect `gain`", assumed},
      {"better_than_common", o.better_than_common, "",
       "one load or gain is wrong if its factor leaves an error so many times smaller on its runs than one factor for "
       "all "
       "loads or gains does",
       plants},
      {"factor_deviations", o.factor_deviations, "",
       "and if the gain of its runs is so many standard deviations of its mean", plants},
      {"least_exact_factor", o.least_exact_factor, "",
       "a smaller factor of a gain or a load is believed from here on, if its correction leaves nothing to explain",
       "loads and gains are read off with less error"},
      {"exact_floors", o.exact_floors, "",
       "which is so if the usual error then is at most so many times what repeats differ by", literature},
      {"exact_evidence", o.exact_evidence, "",
       "and twice the logarithm of the likelihood grows by so much, over no factor and over one effect",
       "five and a half deviations"},
      {"feed_forward_gain", o.feed_forward_gain, "",
       "the feed-forward has another unit or sign if its correction divides the error on its runs by so much", plants},
      {"fitted_runs", o.fitted_runs, "", "runs that the quick model is fitted to", "time of a diagnosis"},
      {"most_faults", o.most_faults, "", "faults that the model is asked for, one after the other", assumed},
  };
}

}  // namespace pmg::data_faults
