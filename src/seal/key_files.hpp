// Keys of a controller and of operators, as files that their owner alone can read.
//
// A controller's folder:  controller.key          its own Ed25519 key
//                         operators/NAME.key      what it shares with operator NAME
// An operator's folder:   any *.key that a controller's owner made for this operator, one a controller
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "seal/authentication.hpp"

namespace pmg::seal {

/// What an operator has: made by pmg_key new.
struct OperatorKey {
  std::string name;        ///< the operator's, as the controller knows it
  PublicKey controller{};  ///< of the controller that made it
  Secret secret{};
};

struct ControllerKeys {
  PrivateKey own{};
  std::map<std::string, Secret> operators;  ///< by name
};

/// (the name of an operator's key, the source of a message) => whether the key is good for it: NAME, or NAME.anything.
/// So nobody drives under another's name.
bool may_speak_as(std::string_view key, std::string_view source) noexcept;

/// XDG_CONFIG_HOME or ~/.config, with pmg/controller-keys and pmg/operator-keys.
std::filesystem::path controller_folder();
std::filesystem::path operator_folder();

/// All of these throw std::runtime_error with one line (file, fault, expectation): a file that is no key, that others
/// may read, or that can't be written.

/// Nothing if the folder has no controller.key.
std::optional<ControllerKeys> read_controller_keys(const std::filesystem::path& folder);
/// Empty if there is no such folder. All are of one operator: its programs have one name for every robot.
std::vector<OperatorKey> read_operator_keys(const std::filesystem::path& folder);

/// Makes the controller's own key if there is none, and a key for this operator, which it returns. Throws if the
/// operator has one. name: 1 to 15 of a-z, A-Z, 0-9, '_', '-'.
OperatorKey make_operator_key(const std::filesystem::path& folder, const std::string& name);
void write_operator_key(const std::filesystem::path& file, const OperatorKey& key);      ///< never over another file
bool revoke_operator_key(const std::filesystem::path& folder, const std::string& name);  ///< false: it had none

}  // namespace pmg::seal
