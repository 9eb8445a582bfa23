#include "trackbed/bag/message.h"

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "src/bag/definitions.h"
#include "trackbed/core/error.h"

// Decodes messages of ROS 2. A message definition in the format ros2msg is parsed to a tree of
// fields. The decoder traverses this field tree and reads each primitive value with Fast CDR, which
// handles alignment and byte order. The format ros2msg has one line per field: type, name, and a
// default or constant value, which the decoder ignores. In ros2msg, the definitions of nested
// message types follow the fields of the message, each after a line of '=' and a line "MSG: TYPE".
namespace trackbed {

/// Types of message fields. These field types are not in an unnamed namespace, because
/// BagMessage::Type has members of these types.
namespace bag_fields {

enum class Primitive {
  kNone,
  kBool,
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64,
  kString
};
enum class Shape { kSingle, kArray, kSequence };

constexpr int kMaxNesting = 16;
constexpr std::size_t kMaxFields = 4096;

struct Field {
  std::string name;
  Primitive primitive = Primitive::kNone;
  std::shared_ptr<const BagMessage::Type> message{};  // type of a field that is no primitive
  Shape shape = Shape::kSingle;
  std::uint64_t count = 1;  // number of elements of an array
};

}  // namespace bag_fields

struct BagMessage::Type {
  std::vector<bag_fields::Field> fields;
};

namespace {

using bag_fields::Field;
using bag_fields::kMaxFields;
using bag_fields::kMaxNesting;
using bag_fields::Primitive;
using bag_fields::Shape;
using Type = BagMessage::Type;

std::optional<Primitive> PrimitiveOf(const std::string& name) {
  static const std::map<std::string, Primitive> primitives{
      {"bool", Primitive::kBool},       {"byte", Primitive::kUint8},
      {"char", Primitive::kUint8},      {"int8", Primitive::kInt8},
      {"uint8", Primitive::kUint8},     {"int16", Primitive::kInt16},
      {"uint16", Primitive::kUint16},   {"int32", Primitive::kInt32},
      {"uint32", Primitive::kUint32},   {"int64", Primitive::kInt64},
      {"uint64", Primitive::kUint64},   {"float32", Primitive::kFloat32},
      {"float64", Primitive::kFloat64}, {"string", Primitive::kString}};
  const auto found = primitives.find(name);
  return found == primitives.end() ? std::nullopt : std::optional(found->second);
}

[[noreturn]] void RefuseType(const std::string& type, std::string message) {
  throw InputError(Problem{.key = type, .message = std::move(message)});
}

/// Returns a type name without "msg/": "nav_msgs/Path" for "nav_msgs/msg/Path".
std::string ShortName(std::string type) {
  const std::size_t at = type.find("/msg/");
  return at == std::string::npos ? type : type.erase(at, 4);
}

/// Builds the tree of a message type's fields.
class TypeBuilder {
 public:
  TypeBuilder(const std::string& type, const std::string& definition) : type_(type) {
    constexpr std::size_t kMaxDefinition = std::size_t{1} << 20U;
    if (definition.size() > kMaxDefinition) {
      RefuseType(type, fmt::format("its definition is longer than {} bytes", kMaxDefinition));
    }
    std::istringstream lines(definition);
    std::string name = ShortName(type);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("===")) {
        name.clear();
      } else if (name.empty() && line.starts_with("MSG:")) {
        std::istringstream(line.substr(4)) >> name;
        name = ShortName(name);
        own_[name];  // the definition of a message without fields is empty
      } else if (name == ShortName(type) && line.starts_with("---")) {
        RefuseType(
            type,
            "its definition, which a line of --- divides, is that of a service or an action; "
            "only messages are read");
      } else if (!name.empty()) {
        own_[name] += line + "\n";
      }
    }
  }

  std::shared_ptr<const Type> Build() { return BuildType(ShortName(type_), 0); }

 private:
  std::shared_ptr<const Type> BuildType(const std::string& name, int depth) {
    if (depth > kMaxNesting) {
      RefuseType(type_, fmt::format("its types are nested deeper than {} levels", kMaxNesting));
    }
    const auto own = own_.find(name);
    const char* built_in = own == own_.end() ? BuiltInDefinition(name) : nullptr;
    if (own == own_.end() && built_in == nullptr) {
      RefuseType(type_, fmt::format("the bag has no definition of the type {}, and Trackbed knows "
                                    "none; record the bag as MCAP, which contains definitions",
                                    name));
    }
    auto type = std::make_shared<Type>();
    std::istringstream lines(own == own_.end() ? built_in : own->second);
    for (std::string line; std::getline(lines, line);) {
      line.erase(std::min(line.find('#'), line.size()));
      std::istringstream words(line);
      std::string kind;
      std::string field;
      if (!(words >> kind >> field)) {
        continue;
      }
      std::string rest;
      std::getline(words, rest);
      const std::size_t text = rest.find_first_not_of(" \t");
      const bool is_constant =
          field.find('=') != std::string::npos || (text != std::string::npos && rest[text] == '=');
      if (!is_constant) {
        type->fields.push_back(BuildField(kind, field, name, depth));
      }
    }
    return type;
  }

  Field BuildField(std::string kind, const std::string& field, const std::string& owner,
                   int depth) {
    if (++fields_ > kMaxFields) {
      RefuseType(type_, fmt::format("it has more than {} fields", kMaxFields));
    }
    Field made{.name = field};
    if (const std::size_t bracket = kind.find('['); bracket != std::string::npos) {
      const std::string inside = kind.substr(bracket + 1, kind.find(']') - bracket - 1);
      kind.erase(bracket);
      const bool is_number = !inside.empty() && inside.size() < 10 &&
                             std::all_of(inside.begin(), inside.end(),
                                         [](unsigned char c) { return std::isdigit(c) != 0; });
      made.shape = is_number ? Shape::kArray : Shape::kSequence;
      made.count = is_number ? std::stoull(inside) : 0;
    }
    kind.erase(std::min(kind.find("<="), kind.size()));  // remove the bound on the string length
    if (const std::optional<Primitive> primitive = PrimitiveOf(kind)) {
      made.primitive = *primitive;
      return made;
    }
    if (kind == "wstring") {
      RefuseType(type_, fmt::format("its field {} has the type wstring, which is not read", field));
    }
    if (kind == "time" || kind == "duration" || kind == "Header") {
      kind = kind == "Header" ? "std_msgs/Header" : "builtin_interfaces/Time";
    }
    // A type name without a package means a type in the same package as the message that contains
    // the field.
    const std::string package = owner.substr(0, owner.find('/'));
    made.message = BuildType(
        ShortName(kind.find('/') == std::string::npos ? package + "/" + kind : kind), depth + 1);
    return made;
  }

  const std::string& type_;
  std::map<std::string, std::string> own_;  // definitions in the bag, keyed by type
  std::size_t fields_ = 0;
};

/// Adds a column name for each numeric field that is not inside an array or a sequence.
void AddColumns(const Type& type, const std::string& prefix, std::vector<std::string>& columns) {
  for (const Field& field : type.fields) {
    if (field.shape != Shape::kSingle || field.primitive == Primitive::kString) {
      continue;
    }
    if (field.message != nullptr) {
      AddColumns(*field.message, prefix + field.name + ".", columns);
    } else {
      columns.push_back(prefix + field.name);
    }
  }
}

const Field* FirstSequence(const Type& type) {
  const auto found = std::find_if(type.fields.begin(), type.fields.end(), [](const Field& field) {
    return field.shape != Shape::kSingle && field.message != nullptr;
  });
  return found == type.fields.end() ? nullptr : &*found;
}

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

/// Reads the fields of a ROS message in order.
class MessageReader {
 public:
  MessageReader(FastBuffer& buffer, std::size_t size)
#if __has_include(<fastcdr/CdrEncoding.hpp>)
      : cdr_(buffer, Cdr::DEFAULT_ENDIAN, eprosima::fastcdr::CdrVersion::XCDRv1),
#else
      : cdr_(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR),
#endif
        size_(size) {
    cdr_.read_encapsulation();
  }

  /// Reads the fields of a message type. If `numbers` is not null, appends to it all numbers that
  /// are not inside an array or sequence.
  void Walk(const Type& type, std::vector<double>* numbers, const Field* sequence,
            std::vector<std::vector<double>>* elements) {
    for (const Field& field : type.fields) {
      std::uint64_t count = field.count;
      if (field.shape == Shape::kSequence) {
        count = Number<std::uint32_t>();
      }
      // Every element of a sequence takes at least one byte, so a message cannot have more elements
      // than bytes.
      if (field.shape != Shape::kSingle && count > size_) {
        Fail(fmt::format("its field {} has {} elements, more than its bytes", field.name, count));
      }
      for (std::uint64_t i = 0; i < count; ++i) {
        if (field.message == nullptr) {
          const double number = ReadPrimitive(field.primitive);
          if (numbers != nullptr && field.shape == Shape::kSingle &&
              field.primitive != Primitive::kString) {
            numbers->push_back(number);
          }
          continue;
        }
        // In ROS 2, a message without fields takes one byte, so the message's number of bytes
        // bounds its number of elements.
        if (++steps_ > 64 * (size_ + kMaxFields)) {
          Fail("it has more elements than its bytes");
        }
        if (&field == sequence && elements != nullptr) {
          elements->emplace_back();
          Walk(*field.message, &elements->back(), nullptr, nullptr);
        } else {
          Walk(*field.message, field.shape == Shape::kSingle ? numbers : nullptr, nullptr, nullptr);
        }
      }
    }
  }

  [[nodiscard]] std::size_t read() const {
#if __has_include(<fastcdr/CdrEncoding.hpp>)
    return cdr_.get_serialized_data_length();
#else
    return cdr_.getSerializedDataLength();
#endif
  }

  [[noreturn]] static void Fail(const std::string& message) {
    throw InputError(Problem{.message = message});
  }

 private:
  template <typename T>
  T Number() {
    T value{};
    cdr_.deserialize(value);
    return value;
  }

  double ReadPrimitive(Primitive primitive) {
    switch (primitive) {
      case Primitive::kBool:
      case Primitive::kUint8:
        return Number<std::uint8_t>();
      case Primitive::kInt8:
        return static_cast<std::int8_t>(Number<std::uint8_t>());
      case Primitive::kInt16:
        return Number<std::int16_t>();
      case Primitive::kUint16:
        return Number<std::uint16_t>();
      case Primitive::kInt32:
        return Number<std::int32_t>();
      case Primitive::kUint32:
        return Number<std::uint32_t>();
      case Primitive::kInt64:
        return static_cast<double>(Number<std::int64_t>());
      case Primitive::kUint64:
        return static_cast<double>(Number<std::uint64_t>());
      case Primitive::kFloat32:
        return Number<float>();
      case Primitive::kFloat64:
        return Number<double>();
      case Primitive::kString:
        SkipText();
        return 0.0;
      case Primitive::kNone:
        break;
    }
    return 0.0;
  }

  /// Skips a text: its length with the final zero, and its bytes. Reads the last byte as a number,
  /// because Fast CDR aligns by the size of the last number read, which jump() does not change.
  void SkipText() {
    const auto length = Number<std::uint32_t>();
    if (length == 0) {
      return;
    }
    if (!cdr_.jump(length - 1)) {
      Fail("a text is longer than the message");
    }
    Number<std::uint8_t>();
  }

  Cdr cdr_;
  std::size_t size_;
  std::uint64_t steps_ = 0;
};

}  // namespace

BagMessage::BagMessage(const std::string& type, const std::string& definition)
    : name_(type), type_(TypeBuilder(type, definition).Build()) {
  AddColumns(*type_, "", columns_);
  if (const Field* sequence = FirstSequence(*type_)) {
    AddColumns(*sequence->message, "", element_columns_);
  }
}

void BagMessage::Read(std::string_view message, std::vector<double>& numbers,
                      std::vector<std::vector<double>>* elements) const {
  numbers.clear();
  // The first two bytes of a CDR message state the byte order.
  if (message.size() < 4 || message[0] != '\0' || (message[1] != '\0' && message[1] != '\x01')) {
    throw InputError(Problem{.key = name_, .message = "a message is not in the encoding CDR"});
  }
  FastBuffer buffer(const_cast<char*>(message.data()), message.size());
  try {
    MessageReader reader(buffer, message.size());
    reader.Walk(*type_, &numbers, FirstSequence(*type_), elements);
    // Some programs pad CDR messages to a multiple of four bytes.
    constexpr std::size_t kPadding = 3;
    if (reader.read() + kPadding < message.size()) {
      MessageReader::Fail(fmt::format(
          "it has {} bytes, but its type has {}: the type of the recorder has other fields",
          message.size(), reader.read()));
    }
  } catch (const eprosima::fastcdr::exception::Exception&) {
    throw InputError(Problem{
        .key = name_,
        .message =
            fmt::format("a message of {} bytes ends before its last field", message.size())});
  } catch (const InputError& error) {
    throw InputError(Problem{
        .key = name_, .message = "a message is damaged: " + error.problems().front().message});
  }
}

std::vector<std::string> BagMessageTypes() {
  std::vector<std::string> types;
  for (std::string type : BuiltInTypes()) {
    types.push_back(type.insert(type.find('/'), "/msg"));
  }
  return types;
}

}  // namespace trackbed
