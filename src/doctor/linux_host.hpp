// The computer that this program runs on.
#pragma once

#include <filesystem>

#include "doctor/host.hpp"

namespace pmg::doctor {

class LinuxHost final : public Host {
 public:
  /// root: the folder below which proc/ and sys/ are.
  explicit LinuxHost(std::filesystem::path root = "/") : root_(std::move(root)) {}

  std::optional<std::string> text(const std::string& path) const override;
  std::vector<std::string> names(const std::string& folder) const override;
  int try_fifo(int priority) const override;
  std::optional<Coalescing> coalescing(const std::string& interface) const override;
  std::vector<std::string> addresses(const std::string& interface) const override;
  std::optional<CanLink> can_link(const std::string& interface, int& error) const override;
  std::string resolved(const std::string& device) const override;
  bool may_use(const std::string& device) const override;
  ClockReading clock() const override;
  DiskSpace disk_space(const std::string& folder) const override;
  WriteSpeed write_speed(const std::string& folder) const override;
  std::string multicast_problem(const std::string& url) const override;

 private:
  std::filesystem::path root_;
};

}  // namespace pmg::doctor
