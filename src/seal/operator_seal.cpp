#include "seal/operator_seal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>
#include <utility>

namespace pmg::seal {

OperatorSeal::OperatorSeal(std::vector<OperatorKey> keys, bool believes_unsigned)
    : keys_(std::move(keys)), believes_unsigned_(believes_unsigned) {}

std::string OperatorSeal::source_name(std::string_view program) const {
  return fmt::format("{}.{}", keys_.empty() ? program : std::string_view(keys_.front().name), ::getpid());
}

std::optional<Peer> OperatorSeal::believe(std::string_view channel, io::Bytes message,
                                          const std::optional<pmg_msgs::proof_t>& proof) const {
  Peer peer;
  if (proof) {
    peer.boot = proof->boot;
    peer.wants_key = !proof->signature.empty();
    pmg_msgs::proof_t bare = *proof;
    bare.signature_size = 0;
    bare.signature.clear();
    const auto text = authenticated_bytes(channel, message, bare);
    for (std::size_t i = 0; i < keys_.size() && peer.wants_key && !peer.key; ++i) {
      if (verified(keys_[i].controller, text, proof->signature)) peer.key = i;
    }
  }
  if (!peer.key && !believes_unsigned_) return std::nullopt;
  return peer;
}

void OperatorSeal::append_seal(std::string_view channel, const Peer& peer) {
  pmg_msgs::seal_t seal{};
  seal.version = pmg_msgs::seal_t::VERSION;
  seal.boot = peer.boot;
  seal.heard_ns = peer.heard_ns;
  if (peer.key) {
    const OperatorKey& key = keys_[*peer.key];
    seal.key = key.name;
    const Code code = code_of(key.secret, authenticated_bytes(channel, buffer_, seal));
    seal.code.assign(code.begin(), code.end());
    seal.code_size = static_cast<std::int32_t>(code.size());
  }
  append(buffer_, seal);
}

OperatorSeal load_operator_seal(const std::string& folder, const std::string& lcm_url) {
  std::vector<OperatorKey> keys =
      read_operator_keys(folder.empty() ? operator_folder() : std::filesystem::path(folder));
  if (keys.empty() && !folder.empty()) {
    throw std::runtime_error(fmt::format("keys {}: expected a folder with an operator's *.key (pmg_key new)", folder));
  }
  const bool believes_unsigned = keys.empty() || (folder.empty() && !io::leaves_this_computer(lcm_url));
  return {std::move(keys), believes_unsigned};
}

}  // namespace pmg::seal
