// Boost.Beast is known here and in server.cpp alone; this server has plain sockets.
#include "web/foxglove_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <limits>
#include <list>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>

#include "web/admission.hpp"
#include "web/beast_text.hpp"

namespace pmg::web {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;
using Tcp = asio::ip::tcp;
using Json = nlohmann::ordered_json;
using Text = std::shared_ptr<const std::string>;

constexpr std::uint8_t kMessageData = 0x01;  // the protocol's only binary message that this server sends
constexpr auto kPatience = std::chrono::seconds(5), kIdle = std::chrono::seconds(20);
const std::array<std::string, 3> kThisComputer = {"localhost", "127.0.0.1", "::1"};

std::string text_of(const Json& json) { return json.dump(-1, ' ', true, Json::error_handler_t::replace); }

/// Of "http://localhost:8080" the host's name; nothing: it has none.
std::optional<std::string> origin_host(std::string_view origin) {
  const std::size_t scheme = origin.find("://");
  return scheme == std::string_view::npos ? std::nullopt : host_name(origin.substr(scheme + 3));
}

bool may_look(std::string_view origin, std::span<const std::string> more) {
  if (origin.empty() || origin == "file://" || origin == "https://app.foxglove.dev") return true;
  if (std::ranges::find(more, origin) != more.end()) return true;
  const auto host = origin_host(origin);
  return host && std::ranges::find(kThisComputer, *host) != kThisComputer.end();
}

/// The protocol that this server would speak among those that the client offers; empty: none.
std::string_view chosen_protocol(std::string_view offered) {
  const auto offers = [&](std::string_view name) {
    for (std::string_view rest = offered; !rest.empty();) {
      const std::size_t comma = rest.find(',');
      std::string_view item = rest.substr(0, comma);
      rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
      while (item.starts_with(' ')) item.remove_prefix(1);
      while (item.ends_with(' ')) item.remove_suffix(1);
      if (item == name) return true;
    }
    return false;
  };
  if (offers(FoxgloveServer::kProtocol)) return FoxgloveServer::kProtocol;
  return offers(FoxgloveServer::kOlderProtocol) ? FoxgloveServer::kOlderProtocol : std::string_view{};
}

void append_little_endian(std::string& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<char>(value >> (8 * i) & 0xff));
}

struct Channel {
  FoxgloveChannel is;
  std::size_t subscribers = 0;
  std::int64_t newest_ns = 0;
  Text newest{};  // of a latched one
};

/// What the server's thread and its callers share. Channels stay for good, from number 1 on.
struct Board {
  mutable std::mutex mutex;
  std::deque<Channel> channels;
  FoxgloveCounts counts;
  int watching = 0;  // clients

  void count(std::uint64_t FoxgloveCounts::*what) {
    const std::lock_guard lock(mutex);
    ++(counts.*what);
  }
  /// mutex is held.
  Channel* find(std::uint64_t number) {
    return number == 0 || number > channels.size() ? nullptr : &channels[static_cast<std::size_t>(number - 1)];
  }
};

Json channel_json(std::uint32_t number, const FoxgloveChannel& channel) {
  return {{"id", number},
          {"topic", channel.topic},
          {"encoding", channel.encoding},
          {"schemaName", channel.schema_name},
          {"schema", channel.schema},
          {"schemaEncoding", channel.schema_encoding}};
}

/// A connection, and the subscriptions of whom it belongs to. For the server's thread.
class Client : public std::enable_shared_from_this<Client> {
 public:
  Client(Tcp::socket&& socket, const FoxgloveSettings& settings, Board& board)
      : socket_(std::move(socket)), settings_(settings), board_(board) {}
  ~Client() {
    if (open_) watch(-1);
    forget_all();
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// full: it is one too many.
  void open(bool full) {
    beast::get_lowest_layer(socket_).expires_after(kPatience);
    http::async_read(socket_.next_layer(), buffer_, request_,
                     [self = shared_from_this(), full](error_code error, std::size_t) {
                       if (!error) self->answer(full);
                     });
  }

  /// The channels that it doesn't know yet.
  void advertise() {
    if (!open_) return;
    Json channels = Json::array();
    {
      const std::lock_guard lock(board_.mutex);
      for (; advertised_ < board_.channels.size(); ++advertised_)
        channels.push_back(channel_json(advertised_ + 1, board_.channels[advertised_].is));
    }
    if (!channels.empty()) tell({{"op", "advertise"}, {"channels", channels}});
  }
  void show(std::uint32_t channel, std::int64_t time_ns, const Text& message, std::size_t waiting) {
    for (const auto& [subscription, subscribed] : subscriptions_) {
      if (subscribed == channel) enqueue({subscription, time_ns, message}, waiting);
    }
    write();
  }

 private:
  struct Waiting {
    std::uint32_t subscription;
    std::int64_t time_ns;
    Text message;
  };

  void answer(bool full) {
    const std::string_view origin = view(request_[http::field::origin]);
    const std::string_view protocol = chosen_protocol(view(request_[http::field::sec_websocket_protocol]));
    if (!is_ours(view(request_[http::field::host]), kThisComputer))
      return refuse(http::status::misdirected_request, &FoxgloveCounts::host);
    if (!may_look(origin, settings_.origins)) return refuse(http::status::forbidden, &FoxgloveCounts::origin);
    if (!websocket::is_upgrade(request_) || protocol.empty())
      return refuse(http::status::bad_request, &FoxgloveCounts::protocol);
    if (full) return refuse(http::status::service_unavailable, &FoxgloveCounts::full);
    beast::get_lowest_layer(socket_).expires_never();
    websocket::stream_base::timeout patience{};
    patience.handshake_timeout = kPatience;
    patience.idle_timeout = kIdle;
    patience.keep_alive_pings = true;
    socket_.set_option(patience);
    socket_.set_option(websocket::stream_base::decorator([protocol](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, beast::string_view(protocol.data(), protocol.size()));
    }));
    socket_.auto_fragment(false);  // messages are small, and clients have it simpler
    socket_.read_message_max(FoxgloveServer::kMostMessage_bytes);
    socket_.async_accept(request_, [self = shared_from_this()](error_code error) {
      if (!error) self->begin();
    });
  }

  void watch(int change) {
    const std::lock_guard lock(board_.mutex);
    board_.watching += change;
  }

  void refuse(http::status status, std::uint64_t FoxgloveCounts::*why) {
    board_.count(why);
    const auto response = std::make_shared<http::response<http::string_body>>(status, 11);
    response->keep_alive(false);
    response->body() = std::string(view(http::obsolete_reason(status))) + "\n";
    response->prepare_payload();
    http::async_write(socket_.next_layer(), *response, [self = shared_from_this(), response](error_code, std::size_t) {
      try {
        self->socket_.next_layer().socket().shutdown(Tcp::socket::shutdown_send);
      } catch (const boost::system::system_error&) {
        return;  // it is gone already
      }
    });
  }

  void begin() {
    board_.count(&FoxgloveCounts::clients);
    open_ = true;
    watch(1);
    tell({{"op", "serverInfo"},
          {"name", settings_.name},
          {"capabilities", Json::array()},
          {"metadata", Json::object()},
          {"sessionId", settings_.session}});
    advertise();
    buffer_.clear();
    read();
  }

  /// These are few, and none is left out.
  void tell(const Json& json) {
    texts_.push_back(text_of(json));
    write();
  }

  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error == websocket::error::message_too_big) self->board_.count(&FoxgloveCounts::oversize);
      if (error) return self->end();
      self->hear();
      self->buffer_.clear();
      if (self->open_) self->read();
    });
  }

  void end() {
    if (std::exchange(open_, false)) watch(-1);
    forget_all();
    texts_.clear();
    waiting_.clear();
    beast::get_lowest_layer(socket_).close();
  }

  void hear() {
    const Json said =
        socket_.got_binary() ? Json() : Json::parse(beast::buffers_to_string(buffer_.data()), nullptr, false);
    if (understood(said)) return;
    board_.count(&FoxgloveCounts::not_understood);
    if (++dropped_ > FoxgloveServer::kMostDropped) return end();
    if (dropped_ > 1) return;
    constexpr int kError = 2;
    tell({{"op", "status"},
          {"level", kError},
          {"message", "This server is for looking: it takes subscriptions alone."}});
  }

  bool understood(const Json& said) {
    if (!said.is_object() || !said.contains("op")) return false;
    if (said["op"] == "subscribe")
      return each(said, "subscriptions", [this](const Json& one) { return subscribe(one); });
    if (said["op"] == "unsubscribe")
      return each(said, "subscriptionIds", [this](const Json& one) { return unsubscribe(one); });
    return false;
  }

  template <typename Take>
  static bool each(const Json& said, const char* key, Take&& take) {
    const auto list = said.find(key);
    if (list == said.end() || !list->is_array()) return false;
    bool all = true;
    for (const Json& one : *list) all = take(one) && all;
    return all;
  }

  static std::optional<std::uint32_t> number(const Json& value) {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
      return std::nullopt;
    return value.get<std::uint32_t>();
  }

  bool subscribe(const Json& one) {
    if (!one.is_object() || !one.contains("id") || !one.contains("channelId")) return false;
    const auto id = number(one["id"]), channel = number(one["channelId"]);
    if (!id || !channel || subscriptions_.contains(*id) || subscriptions_.size() >= FoxgloveServer::kMostSubscriptions)
      return false;
    Waiting newest{.subscription = *id, .time_ns = 0, .message = nullptr};
    {
      const std::lock_guard lock(board_.mutex);
      Channel* found = board_.find(*channel);
      if (found == nullptr) return false;
      ++found->subscribers;
      newest.message = found->newest;
      newest.time_ns = found->newest_ns;
    }
    subscriptions_.emplace(*id, *channel);
    if (newest.message) waiting_.push_back(std::move(newest));
    write();
    return true;
  }

  bool unsubscribe(const Json& one) {
    const auto id = number(one);
    const auto found = id ? subscriptions_.find(*id) : subscriptions_.end();
    if (found == subscriptions_.end()) return false;
    forget(found->second);
    subscriptions_.erase(found);
    std::erase_if(waiting_, [&](const Waiting& waiting) { return waiting.subscription == *id; });
    return true;
  }

  void forget(std::uint32_t channel) {
    const std::lock_guard lock(board_.mutex);
    --board_.find(channel)->subscribers;
  }
  void forget_all() {
    for (const auto& [subscription, channel] : std::exchange(subscriptions_, {})) forget(channel);
  }

  /// Of each subscription so many may wait; one more takes the place of the oldest.
  void enqueue(Waiting message, std::size_t most) {
    const auto is_of_it = [&](const Waiting& waiting) { return waiting.subscription == message.subscription; };
    if (static_cast<std::size_t>(std::ranges::count_if(waiting_, is_of_it)) >= most) {
      waiting_.erase(std::ranges::find_if(waiting_, is_of_it));
      board_.count(&FoxgloveCounts::skipped);
    }
    waiting_.push_back(std::move(message));
  }

  void write() {
    if (!open_ || writing_ || (texts_.empty() && waiting_.empty())) return;
    writing_ = true;
    if (texts_.empty()) {
      const Waiting& next = waiting_.front();
      frame_.clear();
      frame_.push_back(static_cast<char>(kMessageData));
      append_little_endian(frame_, next.subscription, 4);
      append_little_endian(frame_, static_cast<std::uint64_t>(next.time_ns), 8);
      frame_ += *next.message;
      waiting_.pop_front();
      socket_.binary(true);
    } else {
      frame_ = std::move(texts_.front());
      texts_.pop_front();
      socket_.text(true);
    }
    board_.count(&FoxgloveCounts::sent);
    socket_.async_write(asio::buffer(frame_), [self = shared_from_this()](error_code error, std::size_t) {
      self->writing_ = false;
      if (error) return self->end();
      self->write();
    });
  }

  websocket::stream<beast::tcp_stream> socket_;
  const FoxgloveSettings& settings_;
  Board& board_;
  beast::flat_buffer buffer_{FoxgloveServer::kMostMessage_bytes};
  http::request<http::empty_body> request_;
  std::map<std::uint32_t, std::uint32_t> subscriptions_;  // its number for it, by which channel
  std::deque<std::string> texts_;
  std::deque<Waiting> waiting_;
  std::string frame_;
  std::uint64_t dropped_ = 0;
  std::uint32_t advertised_ = 0;  // channels
  bool open_ = false, writing_ = false;
};

}  // namespace

class FoxgloveServer::Thread {
 public:
  explicit Thread(FoxgloveSettings settings) : settings_(std::move(settings)) {
    const Tcp::endpoint endpoint(asio::ip::address_v4::loopback(), settings_.port);
    try {
      acceptor_.open(endpoint.protocol());
      acceptor_.set_option(asio::socket_base::reuse_address(true));
      acceptor_.bind(endpoint);
      acceptor_.listen();
    } catch (const boost::system::system_error& error) {
      throw std::runtime_error(fmt::format("Foxglove's port {}: {}", settings_.port, error.code().message()));
    }
    port_ = acceptor_.local_endpoint().port();
    accept();
    thread_ = std::jthread([this] { io_.run(); });
  }
  ~Thread() {
    io_.stop();
    thread_.join();
  }
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  std::uint16_t port() const { return port_; }
  Board& board() { return board_; }
  template <typename Errand>
  void for_each_client(Errand errand) {
    asio::post(io_, [this, errand = std::move(errand)] {
      for (const std::weak_ptr<Client>& one : clients_)
        if (const auto client = one.lock()) errand(*client);
    });
  }

 private:
  void accept() {
    acceptor_.async_accept([this](error_code error, Tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (!error) take(std::move(socket));
      if (!error) return accept();
      retry_.expires_after(std::chrono::seconds(1));  // no file descriptor is left, for example
      retry_.async_wait([this](error_code) { accept(); });
    });
  }

  void take(Tcp::socket&& socket) {
    try {
      socket.set_option(Tcp::no_delay(true));
      socket.set_option(asio::socket_base::send_buffer_size(kSendBuffer_bytes));
    } catch (const boost::system::system_error&) {
      return;  // it is gone already
    }
    std::erase_if(clients_, [](const std::weak_ptr<Client>& client) { return client.expired(); });
    const auto client = std::make_shared<Client>(std::move(socket), settings_, board_);
    const bool full = clients_.size() >= kMostClients;
    if (!full) clients_.push_back(client);
    client->open(full);
  }

  FoxgloveSettings settings_;
  Board board_;
  asio::io_context io_{1};  // its handlers hold clients, which look at what stands above
  Tcp::acceptor acceptor_{io_};
  asio::steady_timer retry_{io_};
  std::list<std::weak_ptr<Client>> clients_;
  std::uint16_t port_ = 0;
  std::jthread thread_;
};

FoxgloveServer::FoxgloveServer(FoxgloveSettings settings) : thread_(std::make_unique<Thread>(std::move(settings))) {}
FoxgloveServer::~FoxgloveServer() = default;

std::uint16_t FoxgloveServer::port() const { return thread_->port(); }

std::uint32_t FoxgloveServer::add(FoxgloveChannel channel) {
  Board& board = thread_->board();
  std::uint32_t number = 0;
  {
    const std::lock_guard lock(board.mutex);
    board.channels.push_back({.is = std::move(channel)});
    number = static_cast<std::uint32_t>(board.channels.size());
  }
  thread_->for_each_client([](Client& client) { client.advertise(); });
  return number;
}

bool FoxgloveServer::watched() const {
  const std::lock_guard lock(thread_->board().mutex);
  return thread_->board().watching > 0;
}

bool FoxgloveServer::wants(std::uint32_t channel) const {
  Board& board = thread_->board();
  const std::lock_guard lock(board.mutex);
  const Channel* found = board.find(channel);
  return found != nullptr && (found->is.latched || found->subscribers > 0);
}

void FoxgloveServer::send(std::uint32_t channel, std::int64_t time_ns, std::string_view message) {
  Board& board = thread_->board();
  const auto text = std::make_shared<const std::string>(message);
  std::size_t waiting = 0;
  {
    const std::lock_guard lock(board.mutex);
    Channel* found = board.find(channel);
    if (found == nullptr) return;
    if (found->is.latched) {
      found->newest = text;
      found->newest_ns = time_ns;
    }
    if (found->subscribers == 0) return;
    waiting = found->is.waiting;
  }
  thread_->for_each_client([=](Client& client) { client.show(channel, time_ns, text, waiting); });
}

FoxgloveCounts FoxgloveServer::counts() const {
  const std::lock_guard lock(thread_->board().mutex);
  return thread_->board().counts;
}

}  // namespace pmg::web
