// Boost.Beast, which takes most of a minute to compile, is known here and in foxglove_server.cpp alone.
#include "web/server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <chrono>
#include <deque>
#include <list>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "web/admission.hpp"
#include "web/allowance.hpp"
#include "web/beast_text.hpp"

namespace pmg::web {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;
using Tcp = asio::ip::tcp;
using Stream = beast::ssl_stream<beast::tcp_stream>;
using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;

constexpr std::uint64_t kMostHeader_bytes = 8192;
constexpr std::size_t kPiece_bytes = 2048;  // of a message
constexpr std::size_t kMostEnding = 16;     // pages that are closed, whose browsers haven't closed yet
constexpr auto kSweep = std::chrono::seconds(1);
constexpr std::int64_t kCut_ns = 1'000'000'000LL * (Server::kIdle_s + Server::kPatience_s);

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

std::string_view field(const Request& request, http::field name) { return view(request[name]); }

class OpenPage;
class Connection;

/// What the server's thread and its callers share.
struct Board {
  struct Entry {
    std::string paired_as;
    std::deque<std::string> said;
    std::weak_ptr<OpenPage> page;
  };

  mutable std::mutex mutex;
  std::map<std::int32_t, Entry> pages;               // by id, so the oldest first
  std::set<std::int32_t> stops;                      // of these pages, which may have gone since
  std::map<std::string, Asset, std::less<>> assets;  // by path
  Counts counts;
  std::int32_t last_id = 0;

  void count_state(std::size_t bytes) {
    const std::lock_guard lock(mutex);
    ++counts.states;
    counts.state_bytes += bytes;
  }
  void count(std::uint64_t Counts::*what) {
    const std::lock_guard lock(mutex);
    ++(counts.*what);
  }
};

/// For the server's thread.
struct Desk {
  const ServerSettings& settings;
  Board& board;
  std::list<std::weak_ptr<Connection>> waiting{};  // the oldest first
  std::list<std::weak_ptr<OpenPage>> opened{};     // likewise; with those whose end isn't over
};

/// An open WebSocket.
class OpenPage : public std::enable_shared_from_this<OpenPage> {
 public:
  OpenPage(Stream&& stream, Board& board, std::string paired_as)
      : socket_(std::move(stream)), board_(board), paired_as_(std::move(paired_as)) {}

  void open(const Request& request) {
    enter();
    websocket::stream_base::timeout patience{};
    patience.handshake_timeout = std::chrono::seconds(Server::kPatience_s);
    patience.idle_timeout = std::chrono::seconds(Server::kIdle_s);
    patience.keep_alive_pings = true;
    beast::get_lowest_layer(socket_).expires_never();
    socket_.set_option(patience);
    socket_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, beast::string_view(kProtocol.data(), kProtocol.size()));
    }));
    socket_.read_message_max(0);  // hear() judges it: Beast's own end of a page waits for its browser without an end
    socket_.control_callback([this](websocket::frame_type kind, beast::string_view text) {
      heard_ns_ = now_ns();
      if (!signs_.take(heard_ns_)) return drop(&Counts::flooded);
      if (kind == websocket::frame_type::pong) confirm(view(text));
    });
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return self->end();
      self->open_ = true;
      if (self->closing_) return self->tell_end();
      self->read();
      self->write();
    });
  }

  /// Beast waits without an end for a browser that was told to close.
  bool overdue() const { return now_ns() - heard_ns_ > kCut_ns; }
  bool ends() const { return closing_; }
  void cut() {
    end();
    beast::get_lowest_layer(socket_).close();
  }

  /// The newest text replaces one that waits.
  void show(std::string text) {
    next_ = std::move(text);
    write();
  }

  void close(websocket::close_code why) {
    if (closing_) return;
    closing_ = true;
    why_ = why;
    forget();
    next_.reset();
    if (open_) tell_end();
  }

 private:
  /// A page that is busy being written to is cut off.
  void tell_end() {
    if (writing_) return beast::get_lowest_layer(socket_).close();
    socket_.async_close(why_, [self = shared_from_this()](error_code) {});
  }

  void enter() {
    const std::lock_guard lock(board_.mutex);
    id_ = ++board_.last_id;
    board_.pages[id_] = {.paired_as = paired_as_, .said = {}, .page = weak_from_this()};
    ++board_.counts.pages;
  }

  void forget() {
    const std::lock_guard lock(board_.mutex);
    board_.pages.erase(id_);
  }

  void read() {
    socket_.async_read_some(buffer_, kPiece_bytes, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->end();
      self->heard_ns_ = now_ns();
      self->hear();
      if (!self->closing_) self->read();
    });
  }

  void end() {
    closing_ = true;
    next_.reset();
    forget();
  }

  /// A piece of a message, which may be whole now.
  void hear() {
    if (buffer_.size() > Server::kMostMessage_bytes) {
      board_.count(&Counts::oversize);
      return close(websocket::close_code::too_big);
    }
    if (!socket_.is_message_done()) return;
    const std::string text = beast::buffers_to_string(buffer_.data());
    buffer_.consume(buffer_.size());
    if (socket_.got_binary()) return drop(&Counts::binary);
    if (paired_as_.empty()) return drop(&Counts::not_paired);
    const bool stop = text == Server::kStop;
    if (!stop && !allowance_.take(now_ns())) return drop(&Counts::flooded);
    const std::lock_guard lock(board_.mutex);
    const auto found = board_.pages.find(id_);
    if (found == board_.pages.end()) return;
    ++board_.counts.messages;
    if (stop) {
      board_.stops.insert(id_);
      return;
    }
    std::deque<std::string>& said = found->second.said;
    if (said.size() >= Server::kMostUnread) {
      said.pop_front();
      ++board_.counts.overrun;
    }
    said.push_back(text);
  }

  void drop(std::uint64_t Counts::*why) {
    board_.count(why);
    if (++dropped_ > Server::kMostDropped) close(websocket::close_code::policy_error);
  }

  void write() {
    if (!open_ || writing_ || closing_ || !next_ || sent_ - confirmed_ >= Server::kMostOnTheWay) return;
    writing_ = true;
    text_ = std::move(*next_);
    next_.reset();
    board_.count_state(text_.size());
    socket_.text(true);
    socket_.async_write(asio::buffer(text_), [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->end();
      self->number();
    });
  }

  /// A ping behind each text: its answer says that the browser has read as far.
  void number() {
    ++sent_;
    const websocket::ping_data number(std::to_string(sent_));
    socket_.async_ping(number, [self = shared_from_this()](error_code error) {
      self->writing_ = false;
      if (error) return self->end();
      self->write();
    });
  }

  void confirm(std::string_view number) {
    const std::uint64_t value = number.empty() || number.size() > 18 ||
                                        !std::ranges::all_of(number, [](char c) { return c >= '0' && c <= '9'; })
                                    ? 0
                                    : std::stoull(std::string(number));
    if (value <= confirmed_ || value > sent_) return;
    confirmed_ = value;
    write();
  }

  websocket::stream<Stream> socket_;
  Board& board_;
  const std::string paired_as_;
  beast::flat_buffer buffer_{Server::kMostMessage_bytes + kPiece_bytes};
  std::int32_t id_ = 0;
  std::int64_t heard_ns_ = now_ns();
  Allowance allowance_{Server::kMessages_per_s, Server::kMessagesRoom};
  Allowance signs_{Server::kMessages_per_s, Server::kMessagesRoom};  // pings and pongs
  std::uint64_t dropped_ = 0, sent_ = 0, confirmed_ = 0;
  std::optional<std::string> next_;
  std::string text_;
  websocket::close_code why_ = websocket::close_code::none;
  bool open_ = false, writing_ = false, closing_ = false;
};

/// A connection until it is a page's WebSocket: requests one after another.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Tcp::socket&& socket, asio::ssl::context& context, Desk& desk, asio::ip::address from)
      : stream_(std::move(socket), context), desk_(desk), from_(std::move(from)) {}

  const asio::ip::address& from() const { return from_; }

  void open() {
    expire();
    stream_.async_handshake(asio::ssl::stream_base::server, [self = shared_from_this()](error_code error) {
      if (!error) return self->read();
      if (error == beast::error::timeout) self->desk_.board.count(&Counts::slow);
    });
  }

  void cut() { beast::get_lowest_layer(stream_).close(); }

 private:
  void expire() { beast::get_lowest_layer(stream_).expires_after(std::chrono::seconds(Server::kPatience_s)); }

  void read() {
    parser_.emplace();
    parser_->header_limit(kMostHeader_bytes);
    parser_->body_limit(0);
    expire();
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](error_code error, std::size_t) {
      if (!error) return self->answer();
      if (error == http::error::end_of_stream) return self->end();
      if (error == beast::error::timeout) return self->desk_.board.count(&Counts::slow);
      const bool foreign = error.category() == make_error_code(http::error::bad_method).category();
      if (!foreign) return;  // the connection is gone
      self->refuse(http::status::bad_request, &Counts::malformed);
    });
  }

  void answer() {
    const Request& request = parser_->get();
    const std::string_view host = field(request, http::field::host);
    if (!is_ours(host, desk_.settings.names)) return refuse(http::status::misdirected_request, &Counts::host);
    if (websocket::is_upgrade(request)) return open_page(request, host);
    if (request.method() != http::verb::get) return refuse(http::status::method_not_allowed, &Counts::method);
    const std::string_view path = view(request.target());
    const auto asset = asset_at(path);
    if (!asset) return refuse(http::status::not_found, &Counts::path);
    respond(http::status::ok, asset->type, asset->text, request.keep_alive());
  }

  std::optional<Asset> asset_at(std::string_view path) const {
    const std::lock_guard lock(desk_.board.mutex);
    const auto found = desk_.board.assets.find(path);
    return found == desk_.board.assets.end() ? std::nullopt : std::optional(found->second);
  }

  void open_page(const Request& request, std::string_view host) {
    if (view(request.target()) != "/socket") return refuse(http::status::not_found, &Counts::path);
    if (!is_own_origin(field(request, http::field::origin), host))
      return refuse(http::status::forbidden, &Counts::origin);
    const AskedProtocols asked = asked_protocols(field(request, http::field::sec_websocket_protocol));
    if (!asked.ours) return refuse(http::status::bad_request, &Counts::malformed);
    std::optional<std::string> name;
    if (asked.token) {
      name = paired_name(*asked.token);
      if (!name) return refuse(http::status::forbidden, &Counts::token);
    }
    if (!make_room(name.has_value())) return refuse(http::status::service_unavailable, &Counts::full);
    const auto page = std::make_shared<OpenPage>(std::move(stream_), desk_.board, name.value_or(""));
    desk_.opened.push_back(page);
    page->open(request);
  }

  std::optional<std::string> paired_name(std::string_view token) const {
    try {
      return desk_.settings.paired(token);
    } catch (const std::exception&) {  // who can't be looked up isn't paired
      return std::nullopt;
    }
  }

  /// Whether one page more may be opened. The oldest that only looks makes room for another that only looks.
  bool make_room(bool paired) {
    std::size_t alike = 0;
    std::shared_ptr<OpenPage> oldest;
    {
      const std::lock_guard lock(desk_.board.mutex);
      for (const auto& [id, entry] : desk_.board.pages) {
        if (entry.paired_as.empty() == paired) continue;
        ++alike;
        if (!oldest) oldest = entry.page.lock();
      }
    }
    if (alike < (paired ? Server::kMostPaired : Server::kMostReaders)) return true;
    if (paired || !oldest) return false;
    oldest->close(websocket::close_code::try_again_later);
    return true;
  }

  void refuse(http::status status, std::uint64_t Counts::*why) {
    desk_.board.count(why);
    respond(status, "text/plain", std::string(view(http::obsolete_reason(status))) + "\n", false);
  }

  void respond(http::status status, const std::string& type, const std::string& text, bool keep) {
    response_ = Response(status, 11);
    response_.set(http::field::content_type, type.starts_with("image/") ? type : type + "; charset=utf-8");
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("X-Frame-Options", "DENY");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("Cross-Origin-Opener-Policy", "same-origin");
    if (status == http::status::ok)  // older browsers don't count a WebSocket as 'self'
      response_.set("Content-Security-Policy",
                    fmt::format("default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
                                "connect-src 'self' wss://{}; base-uri 'none'; form-action 'none'; "
                                "frame-ancestors 'none'",
                                field(parser_->get(), http::field::host)));
    response_.keep_alive(keep);
    response_.body() = text;
    response_.prepare_payload();
    expire();
    http::async_write(stream_, response_, [self = shared_from_this(), keep](error_code error, std::size_t) {
      if (error) return;
      if (keep) return self->read();
      self->end();
    });
  }

  void end() {
    expire();
    stream_.async_shutdown([self = shared_from_this()](error_code) {});
  }

  Stream stream_;
  Desk& desk_;
  const asio::ip::address from_;
  beast::flat_buffer buffer_{2 * kMostHeader_bytes};
  std::optional<http::request_parser<http::empty_body>> parser_;
  Response response_;
};

Tcp::endpoint endpoint_of(const ServerSettings& settings) {
  error_code error;
  const asio::ip::address address = asio::ip::make_address(settings.address, error);
  if (error) throw std::runtime_error(fmt::format("address \"{}\": expected an IP address", settings.address));
  return {address, settings.port};
}

}  // namespace

class Server::Thread {
 public:
  explicit Thread(ServerSettings settings) : settings_(std::move(settings)) {
    context_.set_options(asio::ssl::context::default_workarounds | asio::ssl::context::no_sslv2 |
                         asio::ssl::context::no_sslv3 | asio::ssl::context::no_tlsv1 | asio::ssl::context::no_tlsv1_1);
    const auto pem = asio::buffer(settings_.certificate.pem);
    try {
      context_.use_certificate_chain(pem);
      context_.use_private_key(pem, asio::ssl::context::pem);
    } catch (const boost::system::system_error& error) {
      throw std::runtime_error("the server's certificate can't be used: " + error.code().message());
    }
    for (const Asset& asset : settings_.assets) board_.assets[asset.path] = asset;
    listen();
    accept();
    sweep();
    thread_ = std::jthread([this] { io_.run(); });
  }
  ~Thread() { io_.stop(); }  // then the thread is waited for
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  std::uint16_t port() const { return port_; }
  Board& board() { return board_; }
  void post(std::int32_t page, std::function<void(OpenPage&)> errand) {
    std::shared_ptr<OpenPage> found;
    {
      const std::lock_guard lock(board_.mutex);
      const auto entry = board_.pages.find(page);
      if (entry != board_.pages.end()) found = entry->second.page.lock();
    }
    if (found) asio::post(io_, [found, errand = std::move(errand)] { errand(*found); });
  }

 private:
  void listen() {
    const Tcp::endpoint endpoint = endpoint_of(settings_);
    try {
      acceptor_.open(endpoint.protocol());
      acceptor_.set_option(asio::socket_base::reuse_address(true));
      acceptor_.bind(endpoint);
      acceptor_.listen();
    } catch (const boost::system::system_error& error) {
      throw std::runtime_error(
          fmt::format("{} port {}: {}", settings_.address, settings_.port, error.code().message()));
    }
    port_ = acceptor_.local_endpoint().port();
  }

  void accept() {
    acceptor_.async_accept([this](error_code error, Tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (!error) take(std::move(socket));
      if (!error) return accept();
      retry_.expires_after(kSweep);  // no file descriptor is left, for example
      retry_.async_wait([this](error_code) { accept(); });
    });
  }

  void sweep() {
    std::size_t ending = 0;
    for (auto one = desk_.opened.rbegin(); one != desk_.opened.rend(); ++one) {
      const std::shared_ptr<OpenPage> page = one->lock();
      if (page && (page->overdue() || (page->ends() && ++ending > kMostEnding))) page->cut();
    }
    std::erase_if(desk_.opened, [](const std::weak_ptr<OpenPage>& page) { return page.expired(); });
    sweep_.expires_after(kSweep);
    sweep_.async_wait([this](error_code) { sweep(); });
  }

  void take(Tcp::socket&& socket) {
    board_.count(&Counts::connections);
    Tcp::endpoint from;
    try {
      from = socket.remote_endpoint();
      socket.set_option(Tcp::no_delay(true));
    } catch (const boost::system::system_error&) {
      return;  // it is gone already
    }
    make_room();
    const auto connection = std::make_shared<Connection>(std::move(socket), context_, desk_, from.address());
    desk_.waiting.push_back(connection);
    connection->open();
  }

  /// One more connection than may wait closes the oldest of the address that holds most.
  void make_room() {
    std::map<asio::ip::address, std::pair<std::size_t, std::shared_ptr<Connection>>> held;
    std::size_t count = 0;
    for (auto one = desk_.waiting.begin(); one != desk_.waiting.end();) {
      const std::shared_ptr<Connection> connection = one->lock();
      if (!connection) {
        one = desk_.waiting.erase(one);
        continue;
      }
      auto& [number, oldest] = held[connection->from()];
      if (number++ == 0) oldest = connection;
      ++count;
      ++one;
    }
    if (count < kMostWaiting) return;
    const auto most =
        std::ranges::max_element(held, {}, [](const auto& entry) { return entry.second.first; })->second.second;
    board_.count(&Counts::full);
    most->cut();
    desk_.waiting.remove_if([&](const std::weak_ptr<Connection>& one) { return one.lock() == most; });
  }

  ServerSettings settings_;
  Board board_;
  Desk desk_{settings_, board_};
  asio::ssl::context context_{asio::ssl::context::tls_server};
  asio::io_context io_{1};
  Tcp::acceptor acceptor_{io_};
  asio::steady_timer retry_{io_}, sweep_{io_};
  std::uint16_t port_ = 0;
  std::jthread thread_;
};

Server::Server(ServerSettings settings) : thread_(std::make_unique<Thread>(std::move(settings))) {}
Server::~Server() = default;

std::uint16_t Server::port() const { return thread_->port(); }

void Server::give_out(Asset asset) {
  const std::lock_guard lock(thread_->board().mutex);
  thread_->board().assets[asset.path] = std::move(asset);
}

std::vector<Said> Server::take() {
  std::vector<Said> said;
  const std::lock_guard lock(thread_->board().mutex);
  for (const std::int32_t id : std::exchange(thread_->board().stops, {})) said.push_back({id, std::string(kStop)});
  for (auto& [id, entry] : thread_->board().pages) {
    for (std::string& text : entry.said) said.push_back({id, std::move(text)});
    entry.said.clear();
  }
  return said;
}

std::vector<Page> Server::pages() const {
  std::vector<Page> pages;
  const std::lock_guard lock(thread_->board().mutex);
  for (const auto& [id, entry] : thread_->board().pages) pages.push_back({id, entry.paired_as});
  return pages;
}

void Server::show(std::int32_t page, std::string text) {
  thread_->post(page, [text = std::move(text)](OpenPage& one) mutable { one.show(std::move(text)); });
}

void Server::close(std::int32_t page) {
  thread_->post(page, [](OpenPage& one) { one.close(websocket::close_code::policy_error); });
}

Counts Server::counts() const {
  const std::lock_guard lock(thread_->board().mutex);
  return thread_->board().counts;
}

}  // namespace pmg::web
