// The parts of every page: uPlot (MIT, third_party/pins), and this room's script and style sheet.
#pragma once

namespace pmg::pages {

extern const char* const kUplotScript;
extern const char* const kUplotStyle;
extern const char* const kPageScript;
extern const char* const kPageStyle;

}  // namespace pmg::pages
