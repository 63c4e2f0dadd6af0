// Pictures of what the residual depends on.
#pragma once

#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "pages/page.hpp"

namespace pmg::diagnosis_page {

/// Adds a section: residual before and after, against each circumstance and over frequency.
void show_residuals(pages::Page& page, const bench::Bench& bench, const diagnosis::Diagnosis& diagnosis,
                    const std::vector<calib::SingleJoint>& runs, unsigned threads);

}  // namespace pmg::diagnosis_page
