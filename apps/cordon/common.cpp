// SPDX-License-Identifier: GPL-3.0-or-later
#include "common.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>
#include <system_error>
#include <unistd.h>

#include <fmt/format.h>

#include "commands.hpp"
#include "core/text.hpp"

namespace cordon::apps {

const char* const exit_codes_help =
    "Exit codes:\n"
    "  0    done\n"
    "  1    internal error\n"
    "  2    invalid input, a file that cannot be read or written, or a model that\n"
    "       contradicts itself under an input\n"
    "  3    a plugin that is needed was refused, or failed\n"
    "  4    a claimed guarantee was violated\n"
    "  5    a solver gave no answer in its limit\n"
    "  6    not enough memory, or threads that cannot be started\n"
    "  130  interrupted by SIGINT or SIGTERM\n"
    "Plugins are searched in: --plugins, the study's \"plugins\" (with --trust-plugins), "
    "CORDON_PLUGIN_PATH, beside the program or its library, "
    "the installed directory.";

Exit exit_for(Errc code) noexcept {
  switch (code) {
    case Errc::dimension:
    case Errc::not_finite:
    case Errc::invalid:
    case Errc::unsupported:
    case Errc::not_enclosed:
    case Errc::io:
      return Exit::invalid;
    case Errc::solver:
    case Errc::time_limit:
      return Exit::unanswered;
    case Errc::violated:
      return Exit::violated;
    case Errc::plugin:
      return Exit::plugin;
    case Errc::internal:
      return Exit::internal;
  }
  return Exit::internal;
}

Exit report_current_exception() noexcept try {
  try {
    throw;
  } catch (const Error& error) {
    complain(error.what());
    return exit_for(error.code());
  } catch (const std::bad_alloc&) {
    complain(
        "not enough memory: the machine has no more, or the process may use no more (ulimit -v)");
    return Exit::resources;
  } catch (const std::system_error& error) {
    const bool no_thread = error.code() == std::errc::resource_unavailable_try_again;
    complain(no_thread ? error.what() : fmt::format("internal error: {}", error.what()));
    if (no_thread) return Exit::resources;
  } catch (const std::exception& error) {
    complain(fmt::format("internal error: {}", error.what()));
  } catch (...) {
    complain("internal error: an unknown exception");
  }
  return Exit::internal;
} catch (...) {
  return Exit::internal;
}

namespace {

/// The sequences of colours that this program writes, to a stream that takes them.
constexpr std::array<std::string_view, 5> colours{"\x1b[0m", "\x1b[1m", "\x1b[1;31m", "\x1b[33m",
                                                  "\x1b[32m"};

/// What is printed, whatever names it holds: only line ends and colours steer the terminal.
std::string shown(std::string_view text, const Paint& paint) {
  std::string out;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t escape = std::min(text.find('\x1b', begin), text.size());
    out += detail::printable_lines(text.substr(begin, escape - begin));
    const auto colour = std::find_if(colours.begin(), colours.end(), [&](std::string_view one) {
      return text.substr(escape).starts_with(one);
    });
    const bool is_colour = !paint.bold("").empty() && colour != colours.end();
    const std::size_t length =
        is_colour ? colour->size() : std::min<std::size_t>(1, text.size() - escape);
    out += is_colour ? std::string(*colour) : detail::printable(text.substr(escape, length));
    begin = escape + length;
  }
  return out;
}

}  // namespace

void print(const std::string& whole) {
  static bool reader_is_gone = false;
  if (reader_is_gone) return;
  const std::string text = shown(whole, Paint(stdout));
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0)
    return;
  if (errno != EPIPE)
    throw Error(Errc::io, fmt::format("cannot write to standard output: {}", std::strerror(errno)));
  reader_is_gone = true;
}

namespace {

void to_stderr(const std::string& whole) {
  const std::string text = shown(whole, Paint(stderr));
  std::fwrite(text.data(), 1, text.size(), stderr);  // nobody is left to be told if this fails
}

}  // namespace

void note(const std::string& text) { to_stderr(text + "\n"); }
void warn(const std::string& text) {
  to_stderr(Paint(stderr).yellow("warning:") + " " + text + "\n");
}
void complain(const std::string& text) {
  to_stderr(Paint(stderr).red("error:") + " " + text + "\n");
}

std::string path_problem(const std::string& text) {
  return text.empty() ? "the name is empty" : "";
}

std::filesystem::path as_operand(const std::filesystem::path& path) {
  return path.string().starts_with('-') ? "." / path : path;
}

Paint::Paint(std::FILE* stream) : on_(isatty(fileno(stream)) == 1) {
  const char *none = std::getenv("NO_COLOR"), *terminal = std::getenv("TERM");
  if ((none && *none) || !terminal || std::strcmp(terminal, "dumb") == 0) on_ = false;
}

std::string Paint::wrap(const char* code, const std::string& text) const {
  return on_ ? fmt::format("\x1b[{}m{}\x1b[0m", code, text) : text;
}

namespace {

/// Number of code points, every byte that does not continue one, without the combining marks U+0300
/// … U+036F.
std::size_t width(const std::string& text) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : '\0');
    const bool combining = byte == 0xCC || (byte == 0xCD && next <= 0xAF);
    count += (byte & 0xC0) != 0x80 && !combining;
  }
  return count;
}

}  // namespace

std::string heading(std::string title) {
  const std::size_t micro = title.find("µs"), unit = std::min(title.find(" ["), title.size());
  for (std::size_t i = 0; i < unit; ++i) {
    const bool small = title[i] >= 'a' && title[i] <= 'z' &&
                       (micro == std::string::npos || i != micro + std::string_view("µ").size());
    if (small) title[i] = static_cast<char>(title[i] - 'a' + 'A');
  }
  return title;
}

std::string table(const std::vector<std::vector<std::string>>& cells, const Paint& paint) {
  std::vector<std::vector<std::string>> rows = cells;
  for (auto& row : rows) std::transform(row.begin(), row.end(), row.begin(), detail::printable);
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += &row == &rows.front() ? paint.bold(row[i]) : row[i];
      if (i + 1 < row.size()) text += std::string(widths[i] - width(row[i]) + 2, ' ');
    }
    while (text.ends_with(' ')) text.pop_back();
    text += '\n';
  }
  return text;
}

std::string quoted(const std::string& word) {
  constexpr const char* plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:+@%=";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

void load_plugins(Registry& registry, std::span<const std::filesystem::path> first) {
  registry.load(default_search_path(first));
}

void warn_refused(const Registry& registry) {
  for (const PluginReport& report : registry.reports()) {
    for (const std::string& component : report.left_out)
      warn(fmt::format("{}: {}; rename it, or remove one of the two", report.file.string(),
                       component));
    if (report.state != PluginReport::State::refused) continue;
    warn(fmt::format("{} was refused: {}; {}", report.file.string(), report.reason, report.fix));
  }
}

std::vector<Component> components(const Registry& registry) {
  std::vector<Component> found;
  for (const std::string& kind : Registry::kinds()) {
    for (const std::string& name : registry.names(kind))
      found.push_back({kind, registry.info(kind, name), registry.plugin_of(kind, name)});
  }
  return found;
}

std::string default_text(const ParamSpec& spec) {
  if (spec.required) return "(required)";
  if (!spec.fallback) return "";
  if (const auto* integer = std::get_if<std::int64_t>(&*spec.fallback))
    return fmt::format("{}", *integer);
  if (const auto* real = std::get_if<double>(&*spec.fallback)) return fmt::format("{}", *real);
  if (const auto* flag = std::get_if<bool>(&*spec.fallback)) return *flag ? "true" : "false";
  if (const auto* text = std::get_if<std::string>(&*spec.fallback)) return *text;
  return "";
}

std::string range_text(const ParamSpec& spec) {
  if (spec.kind == ParamKind::component)
    return spec.component_kind + (spec.matrix_type.empty() ? "" : ", or a matrix");
  if (spec.kind == ParamKind::choice) return fmt::format("{}", fmt::join(spec.choices, " | "));
  if (spec.kind != ParamKind::integer && spec.kind != ParamKind::real) return "";
  const bool whole = spec.kind == ParamKind::integer;
  const double widest = whole ? 0x1p63 : INFINITY;  // an integer's own limits are no range
  const bool below = std::abs(spec.lowest) < widest, above = std::abs(spec.highest) < widest;
  const char* most = spec.at_most.empty() ? "" : ", or {\"at_most\": …}";
  if (below && above) return fmt::format("[{}, {}]{}", spec.lowest, spec.highest, most);
  if (below) return fmt::format("≥ {}", spec.lowest);
  return above ? fmt::format("≤ {}", spec.highest) : "";
}

std::string count(std::int64_t number, const char* noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

std::vector<const PipelineSpec*> pipelines_called(const Study& study, const std::string& name) {
  std::vector<const PipelineSpec*> found;
  std::vector<std::string> names;
  for (const PipelineSpec& pipeline : study.pipelines) {
    names.push_back(pipeline.name);
    if (name.empty() || pipeline.name == name) found.push_back(&pipeline);
  }
  if (found.empty() && !name.empty()) {
    throw InputError(study.file.string(), {{"/pipelines", "there is no pipeline \"" + name + "\"",
                                            suggest(name, names)}});
  }
  return found;
}

std::string time_problem(const std::string& text) {
  double seconds = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, seconds);
  const bool good =
      read.ec == std::errc() && read.ptr == end && std::isfinite(seconds) && seconds > 0;
  return good ? "" : text + " is no time; write seconds, above 0";
}

std::chrono::steady_clock::time_point time_after(double seconds) {
  using Clock = std::chrono::steady_clock;
  const std::chrono::duration<double> limit(std::min(seconds, 1e9));
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(limit);
}

}  // namespace cordon::apps
