// Pages as a browser draws them, in headless Chromium if there is one.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "pages/page.hpp"
#include "temporary_folder.hpp"

namespace pmg::pages {

/// What a test says that is skipped without one.
inline constexpr const char* kNoBrowser =
    "NO CHROMIUM: nobody looks at what pages draw; install chromium or set PMG_BROWSER";

/// PMG_BROWSER, or the first Chromium on the path; nullopt if there is none.
inline std::optional<std::string> find_browser() {
  if (const char* named = std::getenv("PMG_BROWSER")) return named;
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    if (std::system(("command -v " + std::string(name) + " >/dev/null").c_str()) == 0) return name;
  }
  return std::nullopt;
}

/// The document after the script `before` (first in the head) and the script `after` (at the body's end) have run.
inline std::string document_in_browser(const std::string& browser, std::string html, const std::string& before,
                                       const std::string& after) {
  namespace fs = std::filesystem;
  const test::TemporaryFolder temporary;
  const std::string folder = temporary.path().string();
  html.insert(html.find("<style>"), "<script>" + before + "</script>");
  html.insert(html.rfind("</body>"), "<script>" + after + "</script>");
  std::ofstream(fs::path(folder) / "page.html") << html;
  // Four pixels of the canvas per pixel of the page, so reading is finer than the tolerances.
  const std::string command = browser + " --headless --no-sandbox --disable-gpu --no-first-run --disable-sync" +
                              " --disable-background-networking --disable-component-update --hide-scrollbars" +
                              " --force-device-scale-factor=4 --window-size=1000,800 --virtual-time-budget=10000" +
                              " --user-data-dir=" + folder + "/profile --dump-dom file://" + folder + "/page.html 2>" +
                              folder + "/stderr";
  std::string document;
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  char buffer[65536];
  for (std::size_t n = 0; pipe && (n = std::fread(buffer, 1, sizeof buffer, pipe.get())) > 0;)
    document.append(buffer, n);
  return document;
}

/// (likewise) => the JSON that the script `after` has put into an element with the id "found".
inline nlohmann::json found_in_browser(const std::string& browser, const std::string& html, const std::string& before,
                                       const std::string& after) {
  const std::string document = document_in_browser(browser, html, before, after);
  const std::string open = "<pre id=\"found\">";
  const std::size_t begin = document.find(open);
  if (begin == std::string::npos) throw std::runtime_error("the browser drew nothing: " + document.substr(0, 500));
  const std::size_t end = document.find("</pre>", begin);
  return nlohmann::json::parse(document.substr(begin + open.size(), end - begin - open.size()));
}

}  // namespace pmg::pages
