// Histograms as inline SVG, which needs no script.
#pragma once

#include <string>

#include "pages/pictures.hpp"

namespace pmg::pages {

/// Counts on a logarithmic axis. Words give the few values far beyond all others, which would press the rest into one
/// bin.
std::string svg(const Histogram& histogram);

}  // namespace pmg::pages
