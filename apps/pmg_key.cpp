// pmg_key: makes, lists and revokes the keys of operators that may drive the robots of this computer over a network.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <string>

#include "program.hpp"
#include "seal/key_files.hpp"

namespace {

using namespace pmg;
namespace fs = std::filesystem;

enum ExitCode { kOk = 0, kNone = 1 };

constexpr const char* kFooter = R"(
Run it as the user that runs pmg_controller. "new" keeps the controller's part in the folder and writes the operator's part to
a file. Bring that file to the operator by a way that nobody reads, into ~/.config/pmg/operator-keys/, readable by its owner
alone (chmod 600). A running controller takes a new or revoked key into account within two seconds.

Examples:
  pmg_key new anna --out anna.key
  pmg_key list
  pmg_key revoke anna

Exit codes: 0 done, 1 revoke: this operator has no key, 2 bad input, or a file that can't be used.)";

struct Arguments {
  std::string folder, name, out;
};

int make(const Arguments& arguments, const fs::path& folder) {
  const fs::path out = arguments.out.empty() ? fs::path(arguments.name + ".key") : fs::path(arguments.out);
  if (fs::exists(out)) throw std::runtime_error(fmt::format("{}: there is a file already", out.string()));
  const seal::OperatorKey key = seal::make_operator_key(folder, arguments.name);
  try {
    seal::write_operator_key(out, key);
  } catch (const std::exception&) {
    seal::revoke_operator_key(folder, arguments.name);  // nobody has got this key
    throw;
  }
  std::cout << fmt::format("{}: {}'s key; it belongs into ~/.config/pmg/operator-keys/ of that operator alone\n",
                           out.string(), arguments.name);
  return kOk;
}

int list(const fs::path& folder) {
  const auto keys = seal::read_controller_keys(folder);
  if (!keys || keys->operators.empty()) {
    std::cerr << fmt::format("pmg_key: no operator has a key in {}\n", folder.string());
    return kOk;
  }
  for (const auto& [name, secret] : keys->operators) std::cout << name << '\n';
  return kOk;
}

int revoke(const Arguments& arguments, const fs::path& folder) {
  if (seal::revoke_operator_key(folder, arguments.name)) return kOk;
  std::cerr << fmt::format("pmg_key: {} has no key in {}\n", arguments.name, folder.string());
  return kNone;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Makes, lists and revokes operators' keys.", "pmg_key");
  Arguments arguments;
  app.footer(kFooter);
  app.require_subcommand(1);
  app.add_option("--keys", arguments.folder, "the controller's folder; ~/.config/pmg/controller-keys if not given");
  CLI::App* new_key = app.add_subcommand("new", "make a key for an operator")->fallthrough();
  new_key->add_option("NAME", arguments.name, "the operator's name")->required();
  new_key->add_option("--out", arguments.out, "file of the operator's part; NAME.key if not given");
  app.add_subcommand("list", "print the operators that have a key")->fallthrough();
  app.add_subcommand("revoke", "take an operator's key away")
      ->fallthrough()
      ->add_option("NAME", arguments.name, "the operator's name")
      ->required();
  return apps::run_program(app, argc, argv, [&]() -> int {
    const fs::path folder = arguments.folder.empty() ? seal::controller_folder() : fs::path(arguments.folder);
    const std::string request = app.get_subcommands().front()->get_name();
    if (request == "new") return make(arguments, folder);
    return request == "list" ? list(folder) : revoke(arguments, folder);
  });
}
