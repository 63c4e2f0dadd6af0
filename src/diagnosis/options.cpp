#include "diagnosis/options.hpp"

#include "evidence/bench_options.hpp"

namespace pmg::diagnosis {

std::vector<evidence::Option> listed(const JointDiagnosisOptions& o) {
  const char* plants = "hidden plants, seeds 0 to 83";  // docs/explanation/hidden-plants.md
  const char* assumed = "assumed";
  const char* cost = "time of a diagnosis";
  std::vector<evidence::Option> all = {
      {"least_deviations", o.least_deviations, "",
       "an effect is taken if its mean gain over blocks left out is so many of its standard deviations", plants},
      {"least_folds_won", o.least_folds_won, "", "and if it is better in this share of the folds", plants},
      {"amplitude_of_noise", o.amplitude_of_noise, "", "and if the square root of its gain is so many times the noise",
       plants},
      {"amplitude_of_beginning", o.amplitude_of_beginning, "", "and this share of the residual before any effect",
       plants},
      {"gain_of_rest", o.gain_of_rest, "",
       "and if its gain is this share of the residual beyond a correct model's: an effect whose form isn't quite right "
       "leaves a rest that a second one could mend",
       plants},
      {"scratch_amplitude_of_noise", o.scratch_amplitude_of_noise, "",
       "amplitude_of_noise without a model: several effects are expected, the weaker beside the stronger", plants},
      {"scratch_amplitude_of_beginning", o.scratch_amplitude_of_beginning, "", "amplitude_of_beginning without a model",
       plants},
      {"scratch_gain_of_rest", o.scratch_gain_of_rest, "", "gain_of_rest without a model", plants},
      {"nearly_all_of_rest", o.nearly_all_of_rest, "",
       "from this share of the residual beyond a correct model's, amplitude_of_beginning doesn't count: what mends "
       "another effect's form leaves a rest itself; only where the residual without the effect is above "
       "remains_of_noise",
       "doubles of the second family"},
      {"worse_deviations", o.worse_deviations, "",
       "an effect is not taken if runs of a gain, a load or a trajectory left out are predicted worse with it, by so "
       "many standard deviations",
       assumed},
      {"one_torque", o.one_torque, "",
       "two effects are one torque if the squared cosine of what they do to the rollouts, beyond what the other "
       "numbers "
       "can do, is larger: a variance inflation of ten (D. W. Marquardt, Technometrics 12:591, 1970)",
       assumed},
      {"equal_gain", o.equal_gain, "", "gains that differ by less than this share are equal: fewer parameters decide",
       plants},
      {"clearly_deviations", o.clearly_deviations, "",
       "an effect replaces another, or its special case, if it is better by so many standard deviations", plants},
      {"regained_share", o.regained_share, "",
       "a fit without the newest effect that regains this share of its gain was not at its end", plants},
      {"most_effects", o.most_effects, "", "effects that one joint may have", assumed},
      {"apart_deviations", o.apart_deviations, "",
       "two effects are told apart if one is better by so many standard deviations", plants},
      {"apart_share", o.apart_share, "", "and by this share of what is expected were it the truth", plants},
      {"fewest_apart_blocks", o.fewest_apart_blocks, "",
       "on at least so many blocks of half a second in which the two differ", plants},
      {"visible_share", o.visible_share, "",
       "two rollouts differ in a block if the square of their difference is this share of the residual's", plants},
      {"better_form_deviations", o.better_form_deviations, "",
       "a form of an effect replaces a simpler one if it is better by so many standard deviations: less is a tie",
       assumed},
      {"hopeless_form_deviations", o.hopeless_form_deviations, "",
       "a form that is worse by so many standard deviations after a first fit is not fitted to its end", cost},
      {"remains_of_noise", o.remains_of_noise, "",
       "a residual of less than so many times the noise's mean square is not called unexplained: loads are weighed to "
       "a percent, friction changes from day to day",
       plants},
      {"remains_of_beginning", o.remains_of_beginning, "", "nor is one of less than this share of the beginning",
       plants},
      {"coarser_quantum", o.coarser_quantum, "",
       "readings show quantisation if their step is so many times the known one: sensors halve or double theirs",
       plants},
      {"quantum_of_noise", o.quantum_of_noise, "", "and if rounding to it makes up this share of the noise's deviation",
       plants},
      {"gain_tolerance", o.gain_tolerance, "",
       "of the value: how well the base model's gains and torque constants are known", assumed},
      {"damping_tolerance", o.damping_tolerance, "", "the same of a drive's damping and back-EMF", assumed},
      {"friction_tolerance", o.friction_tolerance, "",
       "the same of friction, delay and the rotor's inertia, which change from day to day or come from a data sheet",
       assumed},
      {"load_tolerance", o.load_tolerance, "", "the same of loads", assumed},
      {"deviation_of_tolerance", o.deviation_of_tolerance, "",
       "one standard deviation of such a number, as a share of its tolerance", assumed},
      {"form_of_squares", o.intervals.form_of_squares, "",
       "intervals: share of the squares beyond the noise that counts as one observation, for a form that isn't right",
       plants},
      {"form_of_value", o.intervals.form_of_value, "",
       "intervals: share of the value that two integrators of one joint differ by, beyond the error of the step",
       plants},
      {"widest_tolerance", o.intervals.widest_tolerance, "",
       "intervals: a wider range, as a share of its upper end, is a search's and no tolerance", assumed},
      {"wider", o.intervals.wider, "",
       "intervals: where a parameter's deviation is so many times its difference, the difference becomes as wide: in a "
       "narrower one, a joint that sticks a sample earlier looks like a slope",
       assumed},
      {"widest_difference", o.intervals.widest_difference, "", "intervals: no wider than this share of its range",
       assumed},
      {"widenings", o.intervals.widenings, "", "intervals: so many times", cost},
      {"widened_iterations", o.intervals.iterations, "", "Gauss-Newton iterations each time", cost},
      {"enough_deviations", o.enough_deviations, "",
       "what is asked for should part two effects by so many times apart_deviations: the outcome strays by one",
       assumed},
      {"most_asked_runs", o.most_asked_runs, "", "different runs that are asked for at once", assumed},
      {"most_asked_recordings", o.most_asked_recordings, "", "recordings of them", assumed},
      {"searched_runs", o.searched_runs, "", "runs that effects are chosen on; the result is fitted to all", cost},
      {"fitted_effects", o.fitted_effects, "", "effects of a round that are fitted, the best by their linearisation",
       cost},
      {"exchanged_effects", o.exchanged_effects, "", "effects that are fitted in the place of a cause", cost},
      {"fitted_pairs", o.fitted_pairs, "",
       "pairs of effects that are fitted where no single effect explains a rest, the best by their linearisation",
       cost},
      {"finished_effects", o.finished_effects, "", "of these, fits that are continued to their end", cost},
      {"worth_finishing", o.worth_finishing, "", "share of the best gain from which a fit is continued", cost},
      {"worth_fitting_form", o.worth_fitting_form, "",
       "a further form of an effect is fitted if its start explains this share of what the best start explains", cost},
      {"few_iterations", o.few_iterations, "", "Gauss-Newton iterations of a first fit", cost},
      {"many_iterations", o.many_iterations, "", "of a fit to its end", cost},
      {"settled_squares", o.settled_squares, "",
       "rivals are fitted again about the fit with priors if its squares are below this share of the search's", cost},
  };
  const auto add = [&](const std::string& prefix, std::vector<evidence::Option> options) {
    for (evidence::Option& option : options) {
      option.name = prefix + option.name;
      all.push_back(std::move(option));
    }
  };
  add("assembly.", listed(o.assembly));
  add("odd_runs.", evidence::listed(o.odd_runs));
  add("step.", evidence::listed(o.step));
  add("signatures.", listed(o.signatures));
  add("extension.", listed(o.extension));
  return all;
}

}  // namespace pmg::diagnosis
