#include "engine/graph/sqlite.h"

namespace coppice {

Database::Database(const std::filesystem::path& file, bool create, int timeout_ms) {
  sqlite3* opened = nullptr;
  const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX | (create ? SQLITE_OPEN_CREATE : 0);
  const int code = sqlite3_open_v2(file.c_str(), &opened, flags, nullptr);
  handle_.reset(opened);
  check(code);
  check(sqlite3_busy_timeout(opened, timeout_ms));
}

void Database::check(int code) const {
  if (code == SQLITE_OK || code == SQLITE_ROW || code == SQLITE_DONE) return;
  throw DatabaseError(code, handle_ ? sqlite3_errmsg(handle_.get()) : sqlite3_errstr(code));
}

void Database::execute(const std::string& sql) {
  check(sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr));
}

std::string Database::value(const std::string& sql) {
  Statement statement(*this, sql);
  return statement.step() ? statement.text(0) : std::string();
}

Statement::Statement(Database& database, const std::string& sql) : database_(database) {
  sqlite3_stmt* prepared = nullptr;
  database_.check(sqlite3_prepare_v2(database.handle(), sql.c_str(), -1, &prepared, nullptr));
  statement_.reset(prepared);
}

Statement& Statement::bind(const std::string& text) {
  database_.check(sqlite3_bind_text(statement_.get(), ++bound_, text.data(), static_cast<int>(text.size()),
                                    SQLITE_TRANSIENT));
  return *this;
}

Statement& Statement::bind(double number) {
  database_.check(sqlite3_bind_double(statement_.get(), ++bound_, number));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code != SQLITE_ROW) {
    sqlite3_reset(statement_.get());
    bound_ = 0;
  }
  database_.check(code);
  return code == SQLITE_ROW;
}

std::string Statement::text(int column) const {
  const unsigned char* text = sqlite3_column_text(statement_.get(), column);
  return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

}  // namespace coppice
