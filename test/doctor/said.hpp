// One line of the doctor, found by its name.
#pragma once

#include <algorithm>
#include <string>

#include "doctor/finding.hpp"

namespace pmg::test {

/// "fail: what was found -> what to do"; "no line" when there is none of this name.
inline std::string said(const doctor::Findings& findings, const std::string& check) {
  const auto found = std::ranges::find(findings, check, &doctor::Finding::check);
  if (found == findings.end()) return "no line";
  const char* const verdicts[] = {"ok: ", "warn: ", "fail: "};
  return verdicts[static_cast<int>(found->verdict)] + found->found +
         (found->remedy.empty() ? "" : " -> " + found->remedy);
}

}  // namespace pmg::test
