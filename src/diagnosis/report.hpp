// A diagnosis as a page: pictures first.
#pragma once

#include <string>

#include "diagnosis/diagnose.hpp"
#include "pages/page.hpp"

namespace pmg::diagnosis {

/// Shows the held-out runs if there are any, else the fitted ones. threads: for the rollouts.
pages::Page diagnosis_report(const bench::Bench& bench, const Diagnosis& diagnosis, const DiagnosedRuns& runs,
                             unsigned threads = 1);

/// The verdict as one line: "Coulomb friction, delay: 38.6 mrad before, 12.5 mrad after, on 80 held-out runs".
std::string verdict_text(const bench::Bench& bench, const Diagnosis& diagnosis, const DiagnosedRuns& runs);

}  // namespace pmg::diagnosis
