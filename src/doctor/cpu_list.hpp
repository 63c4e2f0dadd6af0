// The kernel's lists of CPUs: "2-3,6".
#pragma once

#include <set>
#include <string>

namespace pmg::doctor {

/// Empty where there is none; what isn't a number or a range is left out.
std::set<int> cpu_list(const std::string& text);
std::string to_text(const std::set<int>& cpus);  ///< "2, 3, 6"

}  // namespace pmg::doctor
