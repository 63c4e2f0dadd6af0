// Beast's texts as the standard's. For server.cpp and foxglove_server.cpp, which alone know Beast.
#pragma once

#include <boost/beast/core/string.hpp>
#include <string_view>

namespace pmg::web {

inline std::string_view view(boost::beast::string_view text) { return {text.data(), text.size()}; }

}  // namespace pmg::web
