#include <cmath>

#include "tests/fuzz/target.h"
#include "trackbed/bag/bag.h"
#include "trackbed/bag/message.h"

/// Fuzzes a bag: its topics, and all messages of each. The content of the file decides whether it
/// is MCAP or SQLite.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  const std::filesystem::path file = fuzz::Write("bag.mcap", fuzz::Text(data, size));
  fuzz::Expect([&] {
    for (const BagTopic& topic : ReadBagTopics(file).topics) {
      fuzz::Expect([&] {
        const BagMessage message(topic.type, topic.definition);
        std::vector<double> numbers;
        std::vector<std::vector<double>> elements;
        ReadBagMessages(file, topic.name, [&](std::string_view bytes, std::int64_t /*time*/) {
          fuzz::Expect([&] {
            elements.clear();
            message.Read(bytes, numbers, &elements);
            if (numbers.size() != message.columns().size()) {
              std::abort();
            }
          });
        });
      });
    }
  });
  return 0;
}
