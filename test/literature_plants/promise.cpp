#include "promise.hpp"

#include <boost/math/distributions/binomial.hpp>

namespace pmg::literature {

double Promise::chance() const {
  if (of == 0) return 1.0;
  const boost::math::binomial_distribution<> expected(of, promised);
  if (at_least) return boost::math::cdf(expected, kept);
  return kept == 0 ? 1.0 : boost::math::cdf(boost::math::complement(expected, kept - 1));
}

}  // namespace pmg::literature
