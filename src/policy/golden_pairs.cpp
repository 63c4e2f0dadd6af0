#include "policy/golden_pairs.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "policy/onnx_network.hpp"

namespace pmg::policy {

void replay_golden_pairs(OnnxNetwork& network, const std::vector<GoldenPair>& pairs, double tolerance) {
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const GoldenPair& pair = pairs[k];
    network.input() = Eigen::Map<const Eigen::VectorXf>(pair.observation.data(), network.input().size());
    network.run();  // an output that isn't finite differs from every action
    for (std::size_t i = 0; i < pair.action.size(); ++i) {
      const float computed = network.output()[static_cast<Eigen::Index>(i)];
      if (!(std::abs(static_cast<double>(computed - pair.action[i])) <= tolerance)) {
        throw std::invalid_argument(
            fmt::format("golden pair {}, action {}: the network gives {}, training had {} (tolerance {})", k, i,
                        computed, pair.action[i], tolerance));
      }
    }
  }
}

}  // namespace pmg::policy
