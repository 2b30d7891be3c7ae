#include "traverse/page/data.hpp"

#include <kainjow/mustache.hpp>
#include <stdexcept>
#include <utility>

namespace traverse::page {

using Mustache = kainjow::mustache::data;

struct Data::Held {
  Mustache value;
};

Data::Data() : held_(new Held{Mustache(Mustache::type::object)}) {}
Data::Data(bool flag) : held_(new Held{Mustache(flag)}) {}
Data::Data(const char* text) : Data(std::string(text)) {}
Data::Data(std::string text) : held_(new Held{Mustache(text)}) {}

Data Data::list() {
  Data made;
  made.held_->value = Mustache(Mustache::type::list);
  return made;
}

Data::Data(const Data& other) : held_(new Held{other.held_->value}) {}
Data::Data(Data&& other) noexcept = default;
Data& Data::operator=(const Data& other) {
  if (this != &other) held_ = std::make_unique<Held>(Held{other.held_->value});
  return *this;
}
Data& Data::operator=(Data&& other) noexcept = default;
Data::~Data() = default;

void Data::set(const std::string& name, Data part) { held_->value.set(name, part.held_->value); }

void Data::push_back(Data item) { held_->value.push_back(item.held_->value); }

std::string Data::fill(const std::string& text) const {
  kainjow::mustache::mustache made(text);
  if (!made.is_valid()) throw std::invalid_argument(made.error_message());
  std::string filled = made.render(held_->value);
  if (!made.is_valid()) throw std::invalid_argument(made.error_message());  // of a part of it
  return filled;
}

}  // namespace traverse::page
