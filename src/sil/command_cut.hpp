// (commands and what the generator admitted of them) => whether a run followed what was asked, or less.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "pmg/command.hpp"

namespace pmg::sil {

/// Of a run: its commands that were outside the admissible set (reference.hpp, command_limited).
struct CommandCut {
  double for_s = 0.0;         ///< 0: every command was admitted as asked
  std::int64_t commands = 0;  ///< different ones, one after the other
  Command asked, admitted;    ///< of the worst: the largest product of its share that was cut and its time
};

/// "forward 50 m/s asked, 0.8 m/s admitted", and how many more commands; "" where nothing was cut.
std::string cut_text(const CommandCut& cut);

/// `for_s`, `commands`, `worst` and its words; null where nothing was cut.
nlohmann::ordered_json cut_json(const CommandCut& cut);

class CommandCuts {
 public:
  /// One tick in which the robot stood or walked. beyond: the asked command was outside the admissible set.
  void add(const Command& asked, const Command& admitted, bool beyond);
  /// A tick of another mode: nobody asked the robot to follow.
  void skip();

  CommandCut worst() const;

 private:
  /// Takes the command that has just ended. Its last tick counts: before, ramps were on their way from another command,
  /// and their mixture may be beyond the set where neither of the two is.
  void end();

  std::int64_t ticks_ = 0;  ///< of the current command, beyond the set
  bool beyond_ = false;     ///< in its last tick
  Command asked_, admitted_;
  std::int64_t cut_ticks_ = 0, commands_ = 0;
  double worst_ = 0.0;
  Command worst_asked_, worst_admitted_;
};

}  // namespace pmg::sil
