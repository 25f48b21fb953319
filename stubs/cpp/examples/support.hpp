// Shared parts of the examples: the command line, and a table with aligned columns.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fc_runtime/client.hpp"

/// The command line: address and ports of the robot.
struct Args {
  std::string host = "127.0.0.1";
  std::optional<std::uint16_t> command_port;
  std::optional<std::uint16_t> data_port;
  /// Time of the robot for each command.
  std::chrono::milliseconds delay{0};
  /// Threshold and level of compression.
  fc_runtime::Gzip gzip;
  /// Scale of the picture; 1 is its normal size.
  std::size_t picture_scale = 1;
  /// `true` for output in Chinese, `false` for English.
  bool is_chinese = false;
};

/// Returns `true` if the POSIX locale of the environment is Chinese.
inline bool is_environment_chinese() {
  for (const char* name : {"LC_ALL", "LC_MESSAGES", "LANG"}) {
    const char* locale = std::getenv(name);
    if (locale != nullptr && *locale != '\0') return std::string_view(locale).substr(0, 2) == "zh";
  }
  return false;
}

/// Parses the command line. Prints the error and exits if it is invalid.
inline Args parse(int count, char** words, const char* usage) {
  Args args;
  args.is_chinese = is_environment_chinese();
  const auto fail = [&](const std::string& why) {
    std::fprintf(stderr, "%s\n\n%s", why.c_str(), usage);
    std::exit(2);
  };
  const auto number = [&](const std::string& text, unsigned long most) {
    char* end = nullptr;
    const unsigned long value = std::strtoul(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0' || value > most) fail(text + " is no number that fits here");
    return value;
  };
  for (int at = 1; at < count; ++at) {
    const std::string_view word = words[at];
    if (word == "--help" || word == "-h") {
      std::fputs(usage, stdout);
      std::exit(0);
    }
    const std::string value = at + 1 < count ? words[++at] : "";
    if (word == "--host") {
      args.host = value;
    } else if (word == "--command-port") {
      args.command_port = static_cast<std::uint16_t>(number(value, 65535));
    } else if (word == "--data-port") {
      args.data_port = static_cast<std::uint16_t>(number(value, 65535));
    } else if (word == "--delay") {
      args.delay = std::chrono::milliseconds(number(value, 1'000'000));
    } else if (word == "--gzip-from") {
      args.gzip.from_bytes = number(value, 1'000'000'000);
    } else if (word == "--picture-scale") {
      args.picture_scale = number(value, 100);
    } else if (word == "--lang") {
      if (value != "zh" && value != "en") fail(value + " is neither zh nor en");
      args.is_chinese = value == "zh";
    } else {
      fail(std::string(word) + " is no option");
    }
  }
  return args;
}

/// Returns the address and ports as settings of a client.
inline fc_runtime::ClientConfig client_of(const Args& args) {
  fc_runtime::ClientConfig config;
  config.host = args.host;
  config.command_port = args.command_port;
  config.data_port = args.data_port;
  config.gzip = args.gzip;
  return config;
}

/// A table. Each column is as wide as its widest cell on a terminal; a Chinese character takes two
/// columns.
class Table {
 public:
  void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

  void print() const {
    std::vector<std::size_t> widths;
    for (const auto& row : rows_) {
      widths.resize(std::max(widths.size(), row.size()));
      for (std::size_t at = 0; at < row.size(); ++at) {
        widths[at] = std::max(widths[at], columns(row[at]));
      }
    }
    for (const auto& row : rows_) {
      std::string line;
      for (std::size_t at = 0; at < row.size(); ++at) {
        line += row[at] + std::string(widths[at] - columns(row[at]) + 2, ' ');
      }
      line.erase(line.find_last_not_of(' ') + 1);
      std::puts(line.c_str());
    }
  }

 private:
  /// Counts two columns for a character of three bytes or more, which is right for these texts.
  static std::size_t columns(const std::string& text) {
    std::size_t count = 0;
    for (const char c : text) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte < 0x80U || (byte >= 0xC0U && byte < 0xE0U)) count += 1;
      if (byte >= 0xE0U) count += 2;
    }
    return count;
  }

  std::vector<std::vector<std::string>> rows_;
};
