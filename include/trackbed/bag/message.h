#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

/// Decodes messages of ROS 2, in the encoding CDR, by the definitions of their types.
namespace trackbed {

/// A type of messages of ROS 2.
class BagMessage {
 public:
  /// Prepares to read messages of a type, such as "nav_msgs/msg/Odometry". `definition` is the
  /// type's definition in the format ros2msg, followed by the definitions of the types of its
  /// fields. If `definition` is empty, uses the definition of ROS 2 for the types in
  /// BagMessageTypes.
  ///
  /// Throws InputError if there is no definition, if the definition is malformed, or if a field has
  /// the type wstring. Throws InputError, too, if message types are nested deeper than 16 levels,
  /// or if a message has more than 4096 fields in all.
  BagMessage(const std::string& type, const std::string& definition);

  /// Names of the numbers that each message has, such as "pose.pose.position.x" and
  /// "header.stamp.sec". The list of names does not contain numbers in arrays and sequences.
  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }

  /// Names of the numbers of each element of the message's first sequence of messages, such as
  /// "pose.position.x" of the elements of `poses`; empty if there is no such sequence.
  [[nodiscard]] const std::vector<std::string>& element_columns() const { return element_columns_; }

  /// Reads the numbers of a message, in the order of columns(). If `elements` is not null, stores
  /// the numbers of the elements of the first sequence of messages, in the order of
  /// element_columns().
  ///
  /// Throws InputError if the message is shorter or longer than its type, or is not CDR.
  void Read(std::string_view message, std::vector<double>& numbers,
            std::vector<std::vector<double>>* elements = nullptr) const;

  struct Type;

 private:
  std::string name_;
  std::shared_ptr<const Type> type_;
  std::vector<std::string> columns_;
  std::vector<std::string> element_columns_;
};

/// Returns the types whose definitions are built in, for callers that ask before they read a bag
/// without definitions.
std::vector<std::string> BagMessageTypes();

}  // namespace trackbed
