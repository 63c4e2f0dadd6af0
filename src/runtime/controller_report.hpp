// How punctual a run of the threaded controller was: for people and for machines.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "runtime/controller.hpp"

namespace pmg::runtime {

/// Of a stopped controller. Delayed cycles are those that the host began over 2 ms late, listed apart with their times
/// since the first cycle; percentiles are over all cycles.
nlohmann::ordered_json punctuality_json(const Controller& controller);

/// The same as lines of text.
std::vector<std::string> punctuality_lines(const Controller& controller);

/// Says while it runs that a simulation waits for its computer.
class LatenessNews {
 public:
  /// One line when five seconds have passed of which more than a twentieth was lost; else empty.
  std::string since(const std::optional<Turns>& turns);

 private:
  std::int64_t passed_ns_ = 0, lost_ns_ = 0;  // when it was asked last
};

}  // namespace pmg::runtime
