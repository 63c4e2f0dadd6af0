// The F distribution: how large a ratio of two mean squares is by chance.
#pragma once

namespace pmg::fitting {

/// (ratio F, degrees of freedom of its numerator and its denominator) => (probability of a larger ratio by chance). 1
/// without degrees of freedom.
double f_tail(double ratio, double above, double below);

/// Half-width of a two-sided 95 % interval, in standard deviations estimated with so many degrees of freedom (Student
/// 1908). Infinite without degrees of freedom.
double student95(double freedom);

}  // namespace pmg::fitting
