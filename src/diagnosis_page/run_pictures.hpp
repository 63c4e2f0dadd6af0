// Runs of a bench beside their simulation, before and after the diagnosis.
#pragma once

#include "diagnosis/diagnose.hpp"
#include "pages/page.hpp"

namespace pmg::diagnosis_page {

/// Pictures of the usual run, of the fitted run and the held-out run that the simulation misses most after the
/// diagnosis, and of the run that it missed most before; then the list of the fitted runs that it misses most.
/// threads: for the rollouts.
void show_runs(pages::Page& page, const bench::Bench& bench, const diagnosis::Diagnosis& diagnosis,
               const diagnosis::DiagnosedRuns& runs, unsigned threads);

}  // namespace pmg::diagnosis_page
