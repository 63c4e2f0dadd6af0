#include "seal/controller_seal.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <system_error>
#include <utility>

namespace pmg::seal {

ControllerSeal::ControllerSeal(std::optional<ControllerKeys> keys, std::filesystem::path folder)
    : keys_(std::move(keys)), folder_(std::move(folder)), boot_(random_number()) {
  if (!keys_) return;
  signer_.emplace(keys_->own);
  public_key_ = signer_->public_key();
}

void ControllerSeal::set_operators(std::map<std::string, Secret> operators) {
  if (keys_) keys_->operators = std::move(operators);
}

std::string ControllerSeal::refresh() {
  if (!keys_ || folder_.empty()) return "";
  std::map<std::string, Secret> operators;
  std::string trouble;
  try {
    auto keys = read_controller_keys(folder_);
    if (!keys) throw std::runtime_error(fmt::format("keys {}: they are gone", folder_.string()));
    operators = std::move(keys->operators);
  } catch (const std::exception& failure) {
    trouble = failure.what();
  }
  if (operators == keys_->operators && trouble == trouble_) return "";
  trouble_ = trouble;
  set_operators(std::move(operators));
  return trouble.empty() ? fmt::format("operators with a key: {}", keys_->operators.size())
                         : fmt::format("{}; from now on nobody has a key", trouble);
}

ControllerSeal::Judgement ControllerSeal::judge(std::string_view channel, std::string_view source, io::Bytes message,
                                                const std::optional<pmg_msgs::seal_t>& seal,
                                                std::int64_t now_ns) const {
  if (!seal || seal->version != pmg_msgs::seal_t::VERSION || seal->boot != boot_) return Judgement::kNotFresh;
  // No difference of these is taken: a foreign number may be anything.
  if (seal->heard_ns > now_ns || seal->heard_ns < now_ns - kFresh_ns) return Judgement::kNotFresh;
  if (!keys_) return Judgement::kGood;
  const auto found = keys_->operators.find(seal->key);
  if (found == keys_->operators.end() || !may_speak_as(found->first, source)) return Judgement::kNoKey;
  pmg_msgs::seal_t bare = *seal;
  bare.code_size = 0;
  bare.code.clear();
  const Code code = code_of(found->second, authenticated_bytes(channel, message, bare));
  return equal(code, seal->code) ? Judgement::kGood : Judgement::kNoKey;
}

void ControllerSeal::append_proof(std::string_view channel) {
  pmg_msgs::proof_t proof{};
  proof.version = pmg_msgs::proof_t::VERSION;
  proof.boot = boot_;
  if (signer_) {
    const Signature signature = signer_->sign(authenticated_bytes(channel, buffer_, proof));
    proof.signature.assign(signature.begin(), signature.end());
    proof.signature_size = static_cast<std::int32_t>(signature.size());
  }
  append(buffer_, proof);
}

bool ControllerSeal::ours(std::string_view channel, io::Bytes message,
                          const std::optional<pmg_msgs::proof_t>& proof) const {
  if (!keys_) return true;
  if (!proof) return false;
  pmg_msgs::proof_t bare = *proof;
  bare.signature_size = 0;
  bare.signature.clear();
  return verified(public_key_, authenticated_bytes(channel, message, bare), proof->signature);
}

ControllerSeal load_controller_seal(const std::string& folder, const std::string& lcm_url, bool insecure) {
  if (folder.empty() && (insecure || !io::leaves_this_computer(lcm_url))) return ControllerSeal();
  const std::filesystem::path place = folder.empty() ? controller_folder() : std::filesystem::path(folder);
  auto keys = read_controller_keys(place);
  if (!keys) {
    throw std::runtime_error(
        fmt::format("LCM address \"{}\": no keys in {}: make one with \"pmg_key new NAME\"; --insecure-without-keys "
                    "lets everybody who "
                    "reaches this address drive the robot",
                    lcm_url, place.string()));
  }
  return ControllerSeal(std::move(keys), place);
}

}  // namespace pmg::seal
