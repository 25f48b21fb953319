#include "allow.hpp"

#include <charconv>

namespace fc_runtime::detail {

namespace {

/// Returns the bytes of an address. An IPv4 address mapped to IPv6 becomes IPv4.
std::vector<unsigned char> bytes_of(const asio::ip::address& address) {
  if (address.is_v4()) {
    const auto bytes = address.to_v4().to_bytes();
    return {bytes.begin(), bytes.end()};
  }
  const auto bytes = address.to_v6().to_bytes();
  if (address.to_v6().is_v4_mapped()) return {bytes.begin() + 12, bytes.end()};
  return {bytes.begin(), bytes.end()};
}

/// Returns `true` if the first `bits` bits are equal.
bool share(const std::vector<unsigned char>& one, const std::vector<unsigned char>& other,
           std::size_t bits) {
  if (one.size() != other.size()) return false;
  for (std::size_t at = 0; at * 8 < bits; ++at) {
    const std::size_t left = bits - at * 8;
    const unsigned mask = left >= 8 ? 0xFFU : 0xFF00U >> left & 0xFFU;
    if (((one[at] ^ other[at]) & mask) != 0) return false;
  }
  return true;
}

}  // namespace

std::optional<BindError> AllowList::read(const std::vector<Allowed>& allow) {
  for (const Allowed& named : allow) {
    const auto slash = named.network.find('/');
    std::error_code error;
    const auto address = asio::ip::make_address(named.network.substr(0, slash), error);
    Network network{bytes_of(address), 0, named.effects};
    network.prefix = network.bytes.size() * 8;
    bool good = !error;
    if (slash != std::string::npos) {
      const char* end = named.network.data() + named.network.size();
      std::size_t prefix = 0;
      const auto read = std::from_chars(named.network.data() + slash + 1, end, prefix);
      good = good && read.ec == std::errc() && read.ptr == end && prefix <= network.prefix;
      network.prefix = prefix;
    }
    if (!good) return BindError{named.network + " is not a network"};
    networks_.push_back(std::move(network));
  }
  return std::nullopt;
}

const std::vector<Effect>* AllowList::effects(const asio::ip::address& address) const {
  if (networks_.empty()) return &all_;
  const auto bytes = bytes_of(address);
  const Network* smallest = nullptr;
  for (const Network& network : networks_) {
    if (!share(network.bytes, bytes, network.prefix)) continue;
    // The last entry of a network applies.
    if (smallest == nullptr || network.prefix >= smallest->prefix) smallest = &network;
  }
  return smallest != nullptr ? &smallest->effects : nullptr;
}

}  // namespace fc_runtime::detail
