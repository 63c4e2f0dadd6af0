#include "evidence/signature_options.hpp"

namespace pmg::evidence {

std::vector<Option> listed(const SignatureOptions& o) {
  const char* random = "random joints without the effect (test/evidence/signature_test.cpp)";
  const char* assumed = "assumed";
  return {
      {"sure_deviations", o.sure_deviations, "",
       "a check agrees from so many standard deviations on: one in 10000 by chance", assumed},
      {"friction_share", o.friction_share, "",
       "share of the drive that a term along the direction of motion must explain: sampling and a drive at its limit "
       "leave up to 0.8 % without friction",
       random},
      {"constant_share", o.constant_share, "", "the same for constant torques and loads", random},
      {"drive_share", o.drive_share, "",
       "the same for terms that follow the drive: without an effect up to 0.9 % remain", random},
      {"disagrees_share", o.disagrees_share, "",
       "a check disagrees where a term explains surely less than this part of the share above", assumed},
      {"own_share", o.own_share, "", "of a term's rms that the other terms must not imitate", assumed},
      {"fewest_clusters", o.fewest_clusters, "", "stretches of motion that a balance of torques needs", assumed},
      {"rest_worth_rad", o.rest_worth_rad, "rad",
       "smallest dead band, or distance that friction leaves at the lowest gain, that a check names", assumed},
      {"swing_worth_share", o.swing_worth_share, "", "share of the swinging weight that friction must explain",
       assumed},
      {"swing_fewest_clusters", o.swing_fewest_clusters, "", "stretches of free swing that a check needs", assumed},
      {"quantum_fewest_readings", o.quantum_fewest_readings, "", "different readings that a check of their steps needs",
       assumed},
      {"quantum_rounding", o.quantum_rounding, "", "of a step: how far files may round a multiple of it", assumed},
      {"quantum_coarse_rad", o.quantum_coarse_rad, "rad", "finer steps are no quantisation", assumed},
  };
}

}  // namespace pmg::evidence
