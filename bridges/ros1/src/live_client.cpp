#include "live_client.h"

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <stdexcept>
#include <utility>

namespace hapticgiant {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;
using nlohmann::json;
using tcp = asio::ip::tcp;

constexpr auto kPatience = std::chrono::seconds(5);      // for an answer
constexpr auto kPause = std::chrono::milliseconds(500);  // between two attempts
constexpr std::size_t kLargestFile = 64 * 1024 * 1024;   // bytes
constexpr const char *kAll = "all", *kSet = "set";       // requests of parameters

// An IPv6 address without its brackets.
std::string bare(std::string host) {
  if (!host.empty() && host.front() == '[') host = host.substr(1, host.size() - 2);
  return host;
}

}  // namespace

LiveClient::LiveClient(asio::io_context& context, FindLink find_link,
                       std::vector<std::string> topics, std::vector<Publication> publications,
                       LiveEvents events)
    : context_(context),
      find_link_(std::move(find_link)),
      topics_(std::move(topics)),
      publications_(std::move(publications)),
      events_(std::move(events)),
      timer_(context) {
  connect_after(std::chrono::milliseconds(0));
}

LiveClient::~LiveClient() {
  if (connection_) connection_->abandon();
}

void LiveClient::connect_after(std::chrono::milliseconds pause) {
  timer_.expires_after(pause);
  timer_.async_wait([this](error_code error) {
    if (!error) connect();
  });
}

void LiveClient::connect() {
  try {
    link_ = find_link_();
  } catch (const std::exception& error) {
    return closed(error.what());
  }
  connection_ = hg::bridges::connect_live(
      context_, {bare(link_.host), link_.port, "/live?token=" + link_.token}, *this);
}

void LiveClient::closed(const std::string& why) {
  connection_.reset();
  is_open_ = false;
  offers_.clear();
  services_.clear();
  for (auto* requests : {&calls_, &fetches_}) {
    for (auto& [id, on_answer] : std::exchange(*requests, {})) {
      on_answer({false, "the connection was lost", {}});
    }
  }
  connect_after(kPause);
  events_.closed(why);
}

void LiveClient::opened(const std::string& /*server*/) {
  is_open_ = true;
  for (const Publication& one : publications_) {
    offers_[one.topic] = connection_->offer(one.topic, one.type);
  }
  connection_->send({{"op", "getParameters"}, {"parameterNames", json::array()}, {"id", kAll}});
  events_.opened();
}

bool LiveClient::offered(const hg::bridges::LiveChannel& channel) {
  return std::find(topics_.begin(), topics_.end(), channel.topic) != topics_.end();
}

void LiveClient::offered(const hg::bridges::LiveService& service) {
  services_[service.name] = service.id;
}

void LiveClient::withdrawn(const hg::bridges::LiveService& service) {
  services_.erase(service.name);
}

void LiveClient::received(const hg::bridges::LiveChannel& channel, Bytes message) {
  events_.message(channel.topic, message);
}

void LiveClient::clock(std::uint64_t time_ns) { events_.time(time_ns); }

void LiveClient::parameters(const json& values, const std::string& id) {
  if (id == kAll) {
    json names = json::array();
    for (const json& parameter : values) names.push_back(parameter.at("name"));
    connection_->send({{"op", "subscribeParameterUpdates"}, {"parameterNames", names}});
  }
  events_.parameters(values, id == kSet);
}

void LiveClient::status(const std::string& text, bool is_error) { events_.status(text, is_error); }

void LiveClient::answered(std::uint32_t call, Bytes message) {
  answer(calls_, call, {true, {}, std::string(message)});
}

void LiveClient::failed(std::uint32_t call, const std::string& why) {
  answer(calls_, call, {false, why, {}});
}

void LiveClient::fetched(std::uint32_t request, const hg::bridges::LiveAsset& asset) {
  answer(fetches_, request, {asset.is_ok, asset.error, std::string(asset.bytes)});
}

void LiveClient::answer(Requests& requests, std::uint32_t id, const Answer& answer) {
  if (auto request = requests.extract(id)) request.mapped()(answer);
}

void LiveClient::publish(const std::string& topic, Bytes message) {
  const auto offer = offers_.find(topic);
  if (offer != offers_.end()) connection_->publish(offer->second, message);
}

void LiveClient::call(const std::string& service, Bytes request, OnAnswer on_answer) {
  if (!is_open_) return on_answer({false, "not connected to the program", {}});
  const auto found = services_.find(service);
  if (found == services_.end()) {
    return on_answer({false, "the program has no service " + service, {}});
  }
  calls_[++last_id_] = std::move(on_answer);
  if (service == kStop) {
    connection_->call_at_once(found->second, last_id_, request);
  } else {
    connection_->call(found->second, last_id_, request);
  }
}

void LiveClient::fetch(const std::string& uri, OnAnswer on_answer) {
  if (!is_open_) return on_answer({false, "not connected to the program", {}});
  fetches_[++last_id_] = std::move(on_answer);
  connection_->send({{"op", "fetchAsset"}, {"uri", uri}, {"requestId", last_id_}});
}

void LiveClient::set_parameter(const std::string& name, const json& value) {
  if (!is_open_) return;
  connection_->send({{"op", "setParameters"},
                     {"parameters", json::array({{{"name", name}, {"value", value}}})},
                     {"id", kSet}});
}

std::string LiveClient::get(const std::string& path) const {
  try {
    asio::io_context context;
    beast::tcp_stream stream(context);
    http::request<http::empty_body> request(http::verb::get, path, 11);
    request.set(http::field::host, link_.host + ":" + link_.port);
    request.set(http::field::authorization, "Bearer " + link_.token);
    request.set(http::field::connection, "close");
    beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    parser.body_limit(kLargestFile);
    error_code result = asio::error::would_block;
    const auto endpoints = tcp::resolver(context).resolve(bare(link_.host), link_.port);
    stream.expires_after(kPatience);
    const auto finish = [&](error_code error, std::size_t) { result = error; };
    stream.async_connect(endpoints, [&](error_code error, const auto&) {
      if (error) return finish(error, 0);
      http::async_write(stream, request, [&](error_code error, std::size_t size) {
        if (error) return finish(error, size);
        http::async_read(stream, buffer, parser, finish);
      });
    });
    context.run();
    if (result) throw std::runtime_error(result.message());
    if (parser.get().result() != http::status::ok) {
      throw std::runtime_error(std::to_string(parser.get().result_int()) + " " +
                               parser.get().body());
    }
    return parser.release().body();
  } catch (const std::exception& error) {
    throw std::runtime_error(path + " of the program: " + error.what());
  }
}

}  // namespace hapticgiant
