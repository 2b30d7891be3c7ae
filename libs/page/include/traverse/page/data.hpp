#pragma once

#include <memory>
#include <string>

namespace traverse::page {

/// What a template is filled with: a text, a flag, a list, or parts under names. Texts are escaped
/// where the template does not say otherwise; {{> name}} takes a text for a template of its own.
class Data {
 public:
  Data();                  ///< without parts
  Data(bool flag);         // NOLINT: parts are written as what they are
  Data(const char* text);  // NOLINT
  Data(std::string text);  // NOLINT
  static Data list();

  Data(const Data& other);
  Data(Data&& other) noexcept;
  Data& operator=(const Data& other);
  Data& operator=(Data&& other) noexcept;
  ~Data();

  void set(const std::string& name, Data part);
  /// To a list.
  void push_back(Data item);

  /// The template `text` filled with this. \throws std::invalid_argument if it is none.
  std::string fill(const std::string& text) const;

 private:
  struct Held;
  std::unique_ptr<Held> held_;
};

}  // namespace traverse::page
