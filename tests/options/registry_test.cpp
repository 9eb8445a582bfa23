#include "trackbed/options/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/options/method_options.h"

namespace trackbed {
namespace {

struct Walk {
  double speed = 1.5;
  int steps = 10;
};
void Visit(KeyVisitor& keys, Walk& options) {
  keys.Field({"speed", "m/s", ""}, options.speed, Need::kOptional, kPositive);
  keys.Field({"steps", "", ""}, options.steps, Need::kOptional);
}

struct Swim {
  double depth = 2.0;
};
void Visit(KeyVisitor& keys, Swim& options) {
  keys.Field({"depth", "m", ""}, options.depth, Need::kOptional);
}

struct Fly {};
void Visit(KeyVisitor&, Fly&) {}

struct Entry {
  const char* name;
  MethodOptions<Entry> defaults;
};

Registry<Entry> Table() {
  return Registry<Entry>("gait", {{"walk", Walk{}}, {"swim", Swim{}}});
}

TEST(MethodOptions, HoldTheStructTheyAreMadeOf) {
  MethodOptions<Entry> options = Walk{.speed = 2.0};
  EXPECT_TRUE(options.Is<Walk>());
  EXPECT_FALSE(options.Is<Swim>());
  EXPECT_EQ(options.GetIf<Swim>(), nullptr);
  ASSERT_NE(options.GetIf<Walk>(), nullptr);
  options.Get<Walk>().speed = 3.0;
  EXPECT_EQ(options.Get<Walk>().speed, 3.0);
  EXPECT_THROW(static_cast<void>(options.Get<Swim>()), InternalError);
}

TEST(MethodOptions, AreCopiedAsValues) {
  const MethodOptions<Entry> first = Walk{.speed = 2.0};
  MethodOptions<Entry> second = first;
  second.Get<Walk>().speed = 4.0;
  EXPECT_EQ(first.Get<Walk>().speed, 2.0);
  second = Swim{};
  EXPECT_TRUE(second.Is<Swim>());
}

TEST(MethodOptions, AreOfOneMethodIfTheirStructsAre) {
  using Options = MethodOptions<Entry>;
  EXPECT_TRUE(AreOfOneMethod(Options(Walk{.speed = 1.0}), Options(Walk{.speed = 2.0})));
  EXPECT_FALSE(AreOfOneMethod(Options(Walk{}), Options(Swim{})));
}

TEST(MethodOptions, VisitTheKeysOfTheirStruct) {
  MethodOptions<Entry> options = Walk{.speed = 2.5};
  const auto visit = [&](KeyVisitor& keys) { Visit(keys, options); };
  EXPECT_EQ(FindNumber("speed", visit), 2.5);
  EXPECT_EQ(FindNumber("steps", visit), std::nullopt);  // `steps` is an integer, not a double.
  EXPECT_EQ(FindNumber("depth", visit), std::nullopt);
}

TEST(Registry, FindsByNameAndByOptions) {
  const Registry<Entry> table = Table();
  EXPECT_TRUE(table.Find("swim").defaults.Is<Swim>());
  EXPECT_STREQ(table.For(MethodOptions<Entry>(Walk{})).name, "walk");
}

TEST(Registry, NamesTheNearestSpelling) {
  try {
    static_cast<void>(Table().Find("wlak"));
    FAIL() << "there is no such gait";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "unknown gait 'wlak'; did you mean 'walk'?");
  }
}

TEST(Registry, TakesWhatIsAdded) {
  Registry<Entry> table = Table();
  table.Add({"fly", Fly{}});
  EXPECT_TRUE(table.Find("fly").defaults.Is<Fly>());
  EXPECT_EQ(table.entries().size(), 3U);
}

TEST(Registry, RejectsATakenNameATakenTypeAndNoName) {
  Registry<Entry> table = Table();
  const auto message_of = [&](const Entry& entry) -> std::string {
    try {
      table.Add(entry);
      return "added";
    } catch (const PreconditionError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(message_of({"walk", Fly{}}), "a gait named walk is already registered");
  EXPECT_EQ(message_of({"stroll", Walk{}}),
            "the gait stroll has the options type of walk; each needs its own type");
  EXPECT_EQ(message_of({"", Fly{}}), "a gait without a name");
  EXPECT_EQ(table.entries().size(), 2U);
}

TEST(Registry, HasNoEntryForOptionsOfNone) {
  EXPECT_THROW(static_cast<void>(Table().For(MethodOptions<Entry>(Fly{}))), InternalError);
}

}  // namespace
}  // namespace trackbed
