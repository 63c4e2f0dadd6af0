// Progress of long work on a progress line; the first signal interrupts the work.
#pragma once

#include <cmath>
#include <string>

#include "program.hpp"
#include "progress_line.hpp"
#include "work/progress.hpp"

namespace pmg::apps {

/// Shows the present step of the work, or `doing` if the work does not name its steps. Keeps a reference to the line.
inline work::Progress shown(ProgressLine& line, const std::string& doing = "") {
  return {.report =
              [&line, doing](double share, std::string_view now) {
                const std::string_view text = now.empty() ? std::string_view(doing) : now;
                if (std::isnan(share))
                  line.show(text);
                else
                  line.show(share, text);
              },
          .interrupted = [] { return interrupt_requested != 0; }};
}

}  // namespace pmg::apps
