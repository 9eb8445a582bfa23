#include "trackbed/bag/message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "trackbed/core/error.h"

// Tests the decoding of messages against bytes that this test writes by the rules of CDR: four
// bytes of encapsulation, then each number aligned to its size, relative to the first byte after
// the encapsulation.
namespace trackbed {
namespace message_test {

using testing::ElementsAre;
using testing::HasSubstr;

/// Writes CDR in one of the two byte orders.
class Cdr {
 public:
  explicit Cdr(bool little) : little_(little), bytes_(4, '\0') { bytes_[1] = little ? 1 : 0; }

  template <typename T>
  Cdr& Put(T value) {
    bytes_.append((sizeof(T) - (bytes_.size() - 4) % sizeof(T)) % sizeof(T), '\0');
    std::string raw(sizeof(T), '\0');
    std::memcpy(raw.data(), &value, sizeof(T));
    if (!little_) {
      std::reverse(raw.begin(), raw.end());
    }
    bytes_ += raw;
    return *this;
  }
  Cdr& Text(const std::string& text) {
    Put(static_cast<std::uint32_t>(text.size() + 1));
    bytes_ += text + '\0';
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  bool little_;
  std::string bytes_;
};

constexpr const char* kDefinition =
    "# comment\n"
    "uint8 KIND=3\n"
    "uint8 a\n"
    "int16 b 5\n"
    "string<=9 text \"x y\"\n"
    "float32 c  # [m]\n"
    "Inner inner\n"
    "float64[2] skipped\n"
    "int8[<=4] more\n"
    "a/Inner[] rows\n"
    "bool last\n"
    "================================================================================\n"
    "MSG: a/Inner\n"
    "int32 x\n"
    "float64 y\n";

Cdr Example(bool little) {
  Cdr message(little);
  message.Put<std::uint8_t>(200).Put<std::int16_t>(-2).Text("hello").Put(1.5F);
  message.Put<std::int32_t>(-7).Put(0.25).Put(8.0).Put(9.0);
  message.Put<std::uint32_t>(3).Put<std::int8_t>(1).Put<std::int8_t>(2).Put<std::int8_t>(3);
  message.Put<std::uint32_t>(2).Put<std::int32_t>(5).Put(0.5).Put<std::int32_t>(6).Put(0.75);
  message.Put<std::uint8_t>(1);
  return message;
}

std::string ErrorOf(const std::string& type, const std::string& definition,
                    const std::string& bytes) {
  try {
    std::vector<double> numbers;
    BagMessage(type, definition).Read(bytes, numbers);
    return "no error";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(BagMessage, ReadsNumbersInBothByteOrders) {
  const BagMessage message("a/msg/Outer", kDefinition);
  EXPECT_THAT(message.columns(), ElementsAre("a", "b", "c", "inner.x", "inner.y", "last"));
  EXPECT_THAT(message.element_columns(), ElementsAre("x", "y"));
  for (const bool little : {true, false}) {
    std::vector<double> numbers;
    std::vector<std::vector<double>> rows;
    message.Read(Example(little).bytes(), numbers, &rows);
    EXPECT_THAT(numbers, ElementsAre(200.0, -2.0, 1.5, -7.0, 0.25, 1.0));
    EXPECT_THAT(rows, ElementsAre(ElementsAre(5.0, 0.5), ElementsAre(6.0, 0.75)));
  }
}

TEST(BagMessage, RefusesEveryShorterMessage) {
  const std::string bytes = Example(true).bytes();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_NE(ErrorOf("a/msg/Outer", kDefinition, bytes.substr(0, size)), "no error") << size;
  }
  EXPECT_EQ(ErrorOf("a/msg/Outer", kDefinition, bytes), "no error");
  EXPECT_EQ(ErrorOf("a/msg/Outer", kDefinition, bytes + std::string(3, '\0')), "no error");
  EXPECT_THAT(ErrorOf("a/msg/Outer", kDefinition, bytes + std::string(4, '\0')),
              HasSubstr("has other fields"));
}

TEST(BagMessage, BoundsSequences) {
  EXPECT_THAT(ErrorOf("a/msg/B", "a/C[] list\n===\nMSG: a/C\n",
                      Cdr(true).Put<std::uint32_t>(4'000'000'000U).bytes()),
              HasSubstr("4000000000 elements"));
  EXPECT_THAT(ErrorOf("a/msg/B", "float64[] list", Cdr(true).Put<std::uint32_t>(5).bytes()),
              HasSubstr("ends before its last field"));
  EXPECT_THAT(ErrorOf("a/msg/B", "string text", Cdr(true).Put<std::uint32_t>(5).bytes()),
              HasSubstr("longer than the message"));
}

TEST(BagMessage, SaysWhatIsWrongWithADefinition) {
  EXPECT_THAT(ErrorOf("a/msg/B", "a/B b", ""), HasSubstr("nested deeper than 16"));
  EXPECT_THAT(ErrorOf("a/msg/B", "wstring b", ""), HasSubstr("wstring"));
  EXPECT_THAT(ErrorOf("a/msg/B", "", ""), HasSubstr("no definition of the type a/B"));
  EXPECT_THAT(ErrorOf("a/msg/B", "x/Y b", ""), HasSubstr("no definition of the type x/Y"));
  // Recorders of service events store the definition of the service: the event has other fields.
  EXPECT_THAT(ErrorOf("a/srv/Add_Event", "int64 a\nint64 b\n---\nint64 sum", ""),
              HasSubstr("is that of a service or an action"));
  EXPECT_THAT(ErrorOf("nav_msgs/msg/Odometry", "", "abcdefgh"), HasSubstr("encoding CDR"));
}

TEST(BagMessage, KnowsTheTypesOfVehicles) {
  for (const std::string& type : BagMessageTypes()) {
    EXPECT_FALSE(BagMessage(type, "").columns().empty()) << type;
  }
  EXPECT_THAT(BagMessage("nav_msgs/msg/Odometry", "").columns(),
              testing::IsSupersetOf({"header.stamp.sec", "header.stamp.nanosec",
                                     "pose.pose.position.x", "pose.pose.orientation.w",
                                     "twist.twist.linear.x", "twist.twist.angular.z"}));
}

}  // namespace message_test
}  // namespace trackbed
