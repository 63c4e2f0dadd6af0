// The report's pictures of the residual's dependences.
#pragma once

#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "pages/page.hpp"

namespace pmg::diagnosis {

/// Adds a section: residual before and after, against each circumstance and over frequency.
void show_residuals(pages::Page& page, const bench::Bench& bench, const Diagnosis& diagnosis,
                    const std::vector<calib::SingleJoint>& runs, unsigned threads);

}  // namespace pmg::diagnosis
