#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

namespace coppice {

/// What SQLite refused.
class DatabaseError : public std::runtime_error {
 public:
  DatabaseError(int code, const std::string& message) : std::runtime_error(message), code_(code) {}
  /// True when the file is no database, a damaged one or one with other tables: only making it again helps.
  bool unusable() const { return code_ == SQLITE_CORRUPT || code_ == SQLITE_NOTADB || code_ == SQLITE_ERROR; }

 private:
  int code_;
};

/// An open database. Throws DatabaseError. May be used by one thread at a time.
class Database {
 public:
  /// Waits up to `timeout_ms` where another process holds a lock.
  Database(const std::filesystem::path& file, bool create, int timeout_ms);

  /// Statements without results.
  void execute(const std::string& sql);
  /// The first column of the first row.
  std::string value(const std::string& sql);

  sqlite3* handle() const { return handle_.get(); }
  void check(int code) const;

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  };
  std::unique_ptr<sqlite3, Close> handle_;
};

/// A prepared statement. Throws DatabaseError.
class Statement {
 public:
  Statement(Database& database, const std::string& sql);
  /// Gives the next parameter its value.
  Statement& bind(const std::string& text);
  Statement& bind(double number);
  /// Goes to the next row; false at the end, after which parameters can be bound anew.
  bool step();
  std::string text(int column) const;
  double number(int column) const { return sqlite3_column_double(statement_.get(), column); }
  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  Database& database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int bound_ = 0;
};

}  // namespace coppice
