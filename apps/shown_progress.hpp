// Long work on a progress line, ended by the first signal.
#pragma once

#include <cmath>
#include <string>

#include "program.hpp"
#include "progress_line.hpp"
#include "work/progress.hpp"

namespace pmg::apps {

/// Shows what is being done, or `doing` where the work says nothing of it. Keeps a reference to the line.
inline work::Progress shown(ProgressLine& line, const std::string& doing = "") {
  return {.told =
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
