// Recordings of a joint, as its bench engineer makes them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rig.hpp"

namespace pmg::literature {

struct Recording {
  std::vector<double> t_s, q_cmd_rad, dq_cmd_rad_s, feed_forward, q_rad, bus_V, temp_C;
  std::vector<bool> enabled;
};

/// The index-th run of the rig's design with that machine. take: 0 is the recording; others are the same run on another
/// day, with other noise. Two machines with the same seed, index and take meet the same noise.
Recording record(const Machine& machine, const Rig& rig, std::uint64_t seed, std::size_t index, std::uint64_t take = 0);

/// Whether anybody would record this bench: every run stays within half a turn, and most of the time near its command.
bool follows_its_commands(const Machine& machine, const Rig& rig, std::uint64_t seed);

/// Mean absolute difference of two recordings of the same commands, dropouts left out [rad].
double mean_absolute_difference_rad(const Recording& a, const Recording& b);

}  // namespace pmg::literature
