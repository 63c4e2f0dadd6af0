// Every effect of the catalogue that is no cause, and what the model-free checks say, without contradiction: whatever a
// check shows against the result is beside the reason.
#pragma once

#include <string>

#include "diagnosis/diagnose.hpp"
#include "pages/page.hpp"

namespace pmg::diagnosis_page {

/// (check, result) => (how both go together, one line; "" if the check can't tell). A check that shows an effect which
/// is no cause, or that doesn't show a cause, always gets a reason.
std::string beside_the_result(const evidence::Signature& check, const diagnosis::Diagnosis& diagnosis,
                              const diagnosis::DiagnosedRuns& runs);

/// Effects that were looked at closely; then, apart from them, those that weren't.
void show_no_causes(pages::Page& page, const diagnosis::Diagnosis& diagnosis, const diagnosis::DiagnosedRuns& runs);

/// Every model-free check.
void show_checks(pages::Page& page, const diagnosis::Diagnosis& diagnosis, const diagnosis::DiagnosedRuns& runs);

}  // namespace pmg::diagnosis_page
