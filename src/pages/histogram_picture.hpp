// Histograms as inline SVG: they show without a script.
#pragma once

#include <string>

#include "pages/pictures.hpp"

namespace pmg::pages {

/// Counts on a logarithmic axis. The few values far beyond all others are told in words: they would press those into
/// one bin.
std::string svg(const Histogram& histogram);

}  // namespace pmg::pages
