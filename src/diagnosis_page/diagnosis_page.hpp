// A diagnosis as a page: first in plain words, then in pictures and tables.
#pragma once

#include <string>

#include "diagnosis/diagnose.hpp"
#include "pages/page.hpp"

namespace pmg::diagnosis_page {

/// threads: for the rollouts.
pages::Page page_of(const bench::Bench& bench, const diagnosis::Diagnosis& diagnosis,
                    const diagnosis::DiagnosedRuns& runs, unsigned threads = 1);

/// The verdict as one line: "Coulomb friction, delay: 38.6 mrad before, 12.5 mrad after, on 80 held-out runs".
std::string verdict_text(const bench::Bench& bench, const diagnosis::Diagnosis& diagnosis,
                         const diagnosis::DiagnosedRuns& runs);

}  // namespace pmg::diagnosis_page
