// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/text/csv_reader.hpp"

#include <cstring>

namespace cordon::detail {

CsvReader::CsvReader(const std::filesystem::path& file) : file_(file), buffer_(1 << 16) {
  fill();
  if (filled_ >= 3 && std::memcmp(buffer_.data(), "\xEF\xBB\xBF", 3) == 0) at_ = 3;
}

bool CsvReader::fill() {
  filled_ = file_.read(buffer_.data(), buffer_.size());
  at_ = 0;
  return filled_ > 0;
}

int CsvReader::peek() {
  if (at_ == filled_ && !fill()) return end_of_file;
  return static_cast<unsigned char>(buffer_[at_]);
}

int CsvReader::get() {
  const int c = peek();
  if (c == end_of_file) return c;
  ++at_;
  if (c == '\n') ++line_;
  return c;
}

/// Takes the LF of a CR LF along.
bool CsvReader::ends_line(int c) {
  if (c == '\r') {
    if (peek() == '\n') {
      get();
    } else {
      ++line_;
    }
    return true;
  }
  return c == '\n' || c == end_of_file;
}

bool CsvReader::next(CsvRow& row) {
  row.fields.clear();
  row.problem.clear();
  row.line = line_;
  row_bytes_ = 0;
  int c = get();
  if (c == end_of_file) return false;
  if (!ends_line(c)) {
    read_row(row, c);
    return true;
  }
  // a blank line: the end of the file may follow, and then it does not count
  for (c = peek(); c == '\n' || c == '\r'; c = peek()) ends_line(get());
  if (c == end_of_file) return false;
  row.problem = "blank line";
  return true;
}

void CsvReader::read_row(CsvRow& row, int c) {
  for (;;) {
    std::string field;
    if (c == '"') {
      read_quoted(row, field);
      c = get();
      if (!row.problem.empty()) {
        if (!ends_line(c)) skip_line();
        return;
      }
      if (c != ',' && !ends_line(c)) {
        row.problem = "text after a closing quote";
        skip_line();
        return;
      }
    } else {
      while (c != ',' && !ends_line(c)) {
        if (c == '"') row.problem = "a quote inside a field that does not begin with one";
        if (!row.problem.empty() || !grow(row, field, c)) {
          skip_line();
          return;
        }
        c = get();
      }
    }
    row.fields.push_back(std::move(field));
    if (c != ',') return;
    if (!count(row)) {
      skip_line();
      return;
    }
    c = get();
  }
}

/// Up to and with the closing quote.
void CsvReader::read_quoted(CsvRow& row, std::string& field) {
  for (;;) {
    const int c = get();
    if (c == end_of_file) {
      row.problem = "a quote is never closed";
      return;
    }
    if (c == '"') {
      if (peek() != '"') return;
      get();
    }
    if (!grow(row, field, c)) return;
  }
}

bool CsvReader::count(CsvRow& row) {
  if (++row_bytes_ <= row_limit) return true;
  row.problem = "longer than 1 MiB: not a table of numbers, or a quote is never closed";
  return false;
}

bool CsvReader::grow(CsvRow& row, std::string& field, int c) {
  if (!count(row)) return false;
  field += static_cast<char>(c);
  return true;
}

void CsvReader::skip_line() {
  while (!ends_line(get())) {
  }
}

}  // namespace cordon::detail
