#include "trackbed/road_network/open_drive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "tests/road_network/documents.h"
#include "tests/support/error_text.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string WhyNot(const std::string& xml) {
  return ErrorText([&] { static_cast<void>(ParseOpenDrive(xml, "test.xodr")); });
}

std::string RoadError(const RoadText& road) {
  return WhyNot(Document(road.Xml()));
}

std::string Geometry(const std::string& shape, const std::string& length = "100") {
  return "<geometry s='0' x='0' y='0' hdg='0' length='" + length + "'>" + shape + "</geometry>";
}

TEST(OpenDrive, ReadsRoadsLanesMarksAndLinks) {
  RoadText first;
  first.attributes = "name='High Street' junction='-1'";
  first.link = "<successor elementType='road' elementId='b' contactPoint='end'/>";
  first.lanes =
      "<laneOffset s='0' a='0.5' b='0' c='0' d='0'/><laneSection s='0'><center><lane id='0'>"
      "<roadMark sOffset='0' type='solid solid' color='yellow' width='0.2'/></lane></center>"
      "<right><lane id='-1' type='driving'><link><successor id='1'/></link>"
      "<width sOffset='0' a='3' b='0' c='0' d='0'/>"
      "<roadMark sOffset='5' type='broken'/><roadMark sOffset='0' type='solid'/></lane></right>"
      "</laneSection>";
  RoadText second;
  second.id = "b";
  second.attributes = "rule='LHT' junction='7'";
  const RoadNetwork network =
      ParseNetwork(first.Xml() + second.Xml() +
                   "<junction id='7'><connection id='0' incomingRoad='1' connectingRoad='b' "
                   "contactPoint='end'><laneLink from='-1' to='1'/></connection></junction>");
  const Road& road = network.roads.at("1");
  EXPECT_EQ(road.name, "High Street");
  EXPECT_FALSE(road.junction.has_value());
  EXPECT_FALSE(road.left_hand_traffic);
  ASSERT_TRUE(road.successor.has_value());
  EXPECT_EQ(road.successor->id, "b");
  EXPECT_EQ(road.successor->contact, RoadEnd::kEnd);
  EXPECT_FALSE(road.predecessor.has_value());
  ASSERT_EQ(road.sections.size(), 1U);
  const Lane& lane = *road.sections[0].Find(-1);
  EXPECT_EQ(lane.type, "driving");
  EXPECT_EQ(lane.successors, std::vector<int>{1});
  ASSERT_EQ(lane.marks.size(), 2U);
  EXPECT_EQ(lane.marks[0].type, "solid");
  EXPECT_EQ(lane.marks[1].s, 5.0);
  const RoadMark& center = road.sections[0].Find(0)->marks.at(0);
  EXPECT_EQ(center.color, "yellow");
  EXPECT_EQ(center.width, 0.2);
  EXPECT_TRUE(network.roads.at("b").left_hand_traffic);
  EXPECT_EQ(network.roads.at("b").junction, "7");
  const JunctionConnection& connection = network.junctions.at("7").connections.at(0);
  EXPECT_EQ(connection.incoming, "1");
  EXPECT_EQ(connection.contact, RoadEnd::kEnd);
  EXPECT_EQ(connection.lane_links, (std::vector<std::pair<int, int>>{{-1, 1}}));
  EXPECT_TRUE(network.notes.empty());
}

TEST(OpenDrive, ReadsEveryShape) {
  for (const char* shape :
       {"<line/>", "<arc curvature='0.01'/>", "<spiral curvStart='0' curvEnd='+1e-2'/>",
        "<poly3 a='0' b='0' c='0.001' d=' 0 '/>",
        "<paramPoly3 aU='0' bU='100' cU='0' dU='0' aV='0' bV='0' cV='1' dV='0'/>",
        "<paramPoly3 aU='0' bU='1' cU='0' dU='0' aV='0' bV='0' cV='0' dV='0' pRange='arcLength'/>",
        "<userData/><line/>"}) {
    RoadText road;
    road.geometry = Geometry(shape);
    EXPECT_EQ(RoadError(road), "") << shape;
  }
}

TEST(OpenDrive, NotesWhatChangesHeightsAndIsNotRead) {
  RoadText road;
  road.heights =
      "<lateralProfile><crossfall side='both' s='0' a='0.02' b='0' c='0' d='0'/>"
      "</lateralProfile>";
  const RoadNetwork network = ParseNetwork(road.Xml());
  ASSERT_EQ(network.notes.size(), 1U);
  EXPECT_EQ(network.notes[0], "crossfall is not read: road 1");
  EXPECT_FALSE(IsLevel(network.roads.at("1")));
}

TEST(OpenDrive, NotesOtherVersionsAndRefusesOtherGenerations) {
  const std::string road = RoadText{}.Xml();
  const auto of = [&](const std::string& version) {
    return "<OpenDRIVE><header " + version + "/>" + road + "</OpenDRIVE>";
  };
  EXPECT_EQ(ParseOpenDrive(of("revMajor='1' revMinor='8'"), "a").notes.size(), 1U);
  EXPECT_TRUE(ParseOpenDrive(of("revMajor='1' revMinor='4'"), "a").notes.empty());
  EXPECT_THAT(WhyNot(of("revMajor='2' revMinor='0'")), HasSubstr("header.revMajor: version 2.0"));
}

TEST(OpenDrive, NotesAMissingHeaderOrVersion) {
  const std::string road = RoadText{}.Xml();
  const auto notes = [&](const std::string& header) {
    const RoadNetwork network = ParseOpenDrive("<OpenDRIVE>" + header + road + "</OpenDRIVE>", "a");
    EXPECT_EQ(network.roads.size(), 1U) << header;
    return network.notes;
  };
  EXPECT_THAT(notes(""), ElementsAre("the file has no header; it is read as version 1.4 to 1.7"));
  EXPECT_THAT(notes("<header/>"), ElementsAre(HasSubstr("header.revMajor: missing")));
  EXPECT_THAT(notes("<header revMajor='1'/>"), ElementsAre(HasSubstr("header.revMinor: missing")));
  EXPECT_THAT(notes("<header revMajor='one' revMinor='4'/>"),
              ElementsAre(HasSubstr("header.revMajor: 'one' is not a whole number")));
}

TEST(OpenDrive, NamesLineAndPlaceOfEveryProblem) {
  RoadText road;
  road.length = "-5";
  road.geometry = "<geometry s='0' x='nan' y='0' hdg='0x1' length='100'><line/></geometry>";
  const std::string why = RoadError(road);
  EXPECT_THAT(why, HasSubstr("test.xodr:4: road[1].length: -5 is out of range"));
  EXPECT_THAT(why, HasSubstr("test.xodr:7: road[1].planView.geometry[0].x: 'nan' is not a finite"));
  EXPECT_THAT(why, HasSubstr("road[1].planView.geometry[0].hdg: '0x1' is not a finite number"));
}

TEST(OpenDrive, ReadsARoadOfAWrongLengthUpToItsLastGeometry) {
  RoadText road;
  road.geometry = Geometry("<line/>", "50");
  for (const char* length : {"100", "20", "-5", "nan", "x", "0"}) {
    road.length = length;
    const RoadNetwork network = ParseNetwork(road.Xml());
    EXPECT_EQ(network.roads.at("1").length, 50.0) << length;
    EXPECT_THAT(network.notes, ElementsAre(AllOf(HasSubstr("line 4: road[1].length: "),
                                                 HasSubstr("; the road is read up to 50 m"))))
        << length;
  }
  road.length = "50.05";  // A difference of at most 0.1 m is no flaw.
  const RoadNetwork network = ParseNetwork(road.Xml());
  EXPECT_EQ(network.roads.at("1").length, 50.05);
  EXPECT_THAT(network.notes, IsEmpty());
}

TEST(OpenDrive, LeavesOutLaneSectionsBeyondTheRoad) {
  RoadText road;
  road.geometry = Geometry("<line/>", "50");
  std::string beyond = kTwoLanes;
  beyond.replace(beyond.find("s=\"0\""), 5, "s=\"80\"");
  road.lanes = kTwoLanes + beyond;
  const RoadNetwork network = ParseNetwork(road.Xml());
  EXPECT_EQ(network.roads.at("1").sections.size(), 1U);
  EXPECT_THAT(network.notes,
              ElementsAre(HasSubstr("length: 100 m, but its last geometry ends at 50 m; the road "
                                    "is read up to 50 m"),
                          HasSubstr("80 m is not on the road of 50 m; the lane section is left "
                                    "out")));
}

TEST(OpenDrive, RefusesGeometryThatIsNone) {
  const auto why = [](const std::string& geometry) {
    RoadText road;
    road.geometry = geometry;
    return RoadError(road);
  };
  EXPECT_THAT(why(""), HasSubstr("road[1].planView: missing, or without <geometry>"));
  EXPECT_THAT(why(Geometry("")), HasSubstr("without a shape"));
  EXPECT_THAT(why(Geometry("<ark/>")), HasSubstr("unknown shape 'ark'; did you mean 'arc'?"));
  EXPECT_THAT(why(Geometry("<arc/>")), HasSubstr("geometry[0].arc.curvature: missing"));
  EXPECT_THAT(why(Geometry("<line/>", "-1")), HasSubstr("-1 is out of range"));
  EXPECT_THAT(why(Geometry("<line/>", "0")), HasSubstr("all geometries have the length 0"));
  EXPECT_THAT(why(Geometry("<line/>", "inf")), HasSubstr("'inf' is not a finite number"));
  EXPECT_THAT(why(Geometry("<arc curvature='999'/>")), HasSubstr("turns by up to"));
  EXPECT_THAT(
      why(Geometry("<paramPoly3 aU='1' bU='0' cU='0' dU='0' aV='0' bV='0' cV='0' dV='0'/>")),
      HasSubstr("the curve is a point"));
  EXPECT_THAT(
      why(Geometry("<paramPoly3 aU='0' bU='80' cU='0' dU='0' aV='0' bV='0' cV='0' dV='0'/>")),
      HasSubstr("the curve is 80 m long, but its length is 100 m"));
  EXPECT_THAT(why("<geometry s='1' x='0' y='0' hdg='0' length='99'><line/></geometry>"),
              HasSubstr("1 m, but the geometry before ends at 0 m"));
  EXPECT_THAT(why(Geometry("<line/>") + Geometry("<line/>")),
              HasSubstr("0 m, but the geometry before ends at 100 m"));
}

TEST(OpenDrive, RefusesLanesThatDoNotFitTogether) {
  const auto why = [](const std::string& lanes) {
    RoadText road;
    road.lanes = lanes;
    return RoadError(road);
  };
  const std::string width = "<width sOffset='0' a='3' b='0' c='0' d='0'/>";
  const std::string center = "<center><lane id='0'/></center>";
  const auto right = [&](const std::string& lane) {
    return "<laneSection s='0'>" + center + "<right>" + lane + "</right></laneSection>";
  };
  EXPECT_THAT(why(""), HasSubstr("laneSection: missing"));
  EXPECT_THAT(why("<laneSection s='0'/>"), HasSubstr("center: missing"));
  EXPECT_THAT(why("<laneSection s='3'>" + center + "</laneSection>"),
              HasSubstr("the first lane section must begin at 0"));
  EXPECT_THAT(why(right("<lane id='-2'>" + width + "</lane>")),
              HasSubstr("lane 0 is followed by lane -2"));
  EXPECT_THAT(why(right("<lane id='-1'>" + width + "</lane><lane id='-1'>" + width + "</lane>")),
              HasSubstr("lane -1 is followed by lane -1"));
  EXPECT_THAT(why(right("<lane id='1'>" + width + "</lane>")), HasSubstr("1 must be below 0"));
  EXPECT_THAT(why(right("<lane id='-2147483648'>" + width + "</lane>")),
              HasSubstr("must be at least -100 and at most 100"));
  EXPECT_THAT(why(right("<lane id='-1.5'>" + width + "</lane>")), HasSubstr("not a whole number"));
  EXPECT_THAT(why(right("<lane id='-1'/>")), HasSubstr("neither <width> nor <border>"));
  EXPECT_THAT(why(right("<lane id='-1'><width sOffset='9' a='3' b='0' c='0' d='0'/></lane>")),
              HasSubstr("the first must begin at 0"));
  EXPECT_THAT(why("<laneOffset s='0' a='1' b='0' c='0' d='0'/>" +
                  right("<lane id='-1'><border sOffset='0' a='-3' b='0' c='0' d='0'/></lane>")),
              HasSubstr("not allowed with a <laneOffset>"));
}

/// The notes on a network, in one text.
std::string Notes(const std::string& content) {
  std::string all;
  for (const std::string& note : ParseNetwork(content).notes) {
    all += note + "\n";
  }
  return all;
}

TEST(OpenDrive, ReadsRecordsInTheOrderOfTheirStations) {
  RoadText road;
  road.lanes =
      "<laneOffset s='0' a='0' b='0' c='0' d='0'/><laneOffset s='60' a='0.5' b='0' c='0' d='0'/>"
      "<laneOffset s='40' a='0.25' b='0' c='0' d='0'/>" +
      kTwoLanes;
  const RoadNetwork network = ParseNetwork(road.Xml());
  const PiecewiseCubic& offset = network.roads.at("1").lane_offset;
  EXPECT_EQ(offset.At(39.0).value, 0.0);
  EXPECT_EQ(offset.At(41.0).value, 0.25);
  EXPECT_EQ(offset.At(61.0).value, 0.5);
  EXPECT_THAT(Notes(road.Xml()), HasSubstr("40 m is before the record above, at 60 m"));
}

TEST(OpenDrive, NotesLinksToWhatIsNotThere) {
  RoadText road;
  road.link = "<successor elementType='road' elementId='9' contactPoint='start'/>";
  EXPECT_THAT(Notes(road.Xml()), HasSubstr("road[1].link.successor: road '9' is not there"));
  road.link = "<predecessor elementType='junction' elementId='9'/>";
  EXPECT_THAT(Notes(road.Xml()), HasSubstr("road[1].link.predecessor: junction '9' is not there"));
  road.link = "<successor elementType='rode' elementId='9'/>";
  EXPECT_THAT(Notes(road.Xml()), HasSubstr("'rode'; did you mean 'road'?"));
  road.link = "<successor elementType='road' elementId='1'/>";
  EXPECT_THAT(Notes(road.Xml()), HasSubstr("link.successor.contactPoint: missing"));
  const std::string connection =
      "<connection incomingRoad='1' connectingRoad='4' contactPoint='start'/>";
  EXPECT_THAT(Notes(RoadText{}.Xml() + "<junction id='2'>" + connection + "</junction>"),
              HasSubstr("junction[2].connection[0].connectingRoad: road '4' is not there"));
  RoadText twice;
  EXPECT_THAT(WhyNot(Document(twice.Xml() + twice.Xml())), HasSubstr("there are two of this id"));
}

TEST(OpenDrive, NotesLaneLinksToWhatIsNotThere) {
  RoadText road;
  road.lanes =
      "<laneSection s='0'><center><lane id='0'/></center><right><lane id='-1' type='driving'>"
      "<link><successor id='-3'/></link><width sOffset='0' a='3' b='0' c='0' d='0'/></lane>"
      "</right></laneSection>" +
      kTwoLanes;
  road.lanes.replace(road.lanes.rfind("s=\"0\""), 5, "s=\"50\"");
  EXPECT_THAT(Notes(road.Xml()), HasSubstr("laneSection[0].lane[-1].link.successor: links to lane "
                                           "-3, which is not there"));
}

/// A road of 100 m along y = 100 `place` with the number `place` as id.
RoadText RoadNumber(int place) {
  RoadText road;
  road.id = std::to_string(place);
  road.geometry = fmt::format(
      "<geometry s='0' x='0' y='{}' hdg='0' length='100'><line/></geometry>", 100 * place);
  return road;
}

// If one road is broken, the other roads can still be used.
TEST(OpenDrive, LeavesOutBrokenRoadsWithANote) {
  RoadText broken = RoadNumber(2);
  broken.lanes = "<laneSection s='0'/>";
  const RoadNetwork network = ParseNetwork(RoadNumber(1).Xml() + broken.Xml());
  EXPECT_EQ(network.roads.size(), 1U);
  EXPECT_THAT(network.broken.at("road 2"), HasSubstr("road[2].lanes.laneSection[0].center"));
  EXPECT_THAT(network.notes.at(0), HasSubstr("road 2 is left out: line "));
  // Roads of the same id are all left out.
  const RoadNetwork twice =
      ParseNetwork(RoadNumber(1).Xml() + RoadNumber(2).Xml() + RoadNumber(2).Xml());
  EXPECT_EQ(twice.roads.size(), 1U);
  EXPECT_THAT(twice.broken.at("road 2"), HasSubstr("two of this id"));
}

TEST(OpenDrive, ReadsRoadsOfLessThanAMicrometer) {
  RoadText tiny = RoadNumber(2);
  tiny.length = "2e-7";
  tiny.geometry = "<geometry s='0' x='0' y='0' hdg='0' length='2e-7'><line/></geometry>";
  EXPECT_EQ(ParseNetwork(RoadNumber(1).Xml() + tiny.Xml()).roads.at("2").length, 2e-7);
}

TEST(OpenDrive, NotesWrongRoadMarks) {
  RoadText road;
  road.lanes =
      "<laneSection s='0'><center><lane id='0'>"
      "<roadMark sOffset='-0.5' type='solid'/><roadMark sOffset='5' type='broken' width='wide'/>"
      "</lane></center></laneSection>";
  const RoadNetwork network = ParseNetwork(road.Xml());
  const std::vector<RoadMark>& marks = network.roads.at("1").sections[0].lanes[0].marks;
  ASSERT_EQ(marks.size(), 1U);
  EXPECT_EQ(marks[0].s, 0.0);
  EXPECT_THAT(network.notes.at(0), HasSubstr("roadMark[0].sOffset: -0.5 m; the mark is drawn"));
  EXPECT_THAT(network.notes.at(1), HasSubstr("roadMark[1].width: 'wide' is not a finite number"));
}

TEST(OpenDrive, RefusesWhatIsNoOpenDrive) {
  EXPECT_THAT(WhyNot(""), HasSubstr("the file is empty"));
  EXPECT_THAT(WhyNot("mission: {}"), HasSubstr("not XML"));
  EXPECT_THAT(WhyNot("<OpenDRIVE><header"), HasSubstr("not XML"));
  EXPECT_THAT(WhyNot("<mujoco/>"), HasSubstr("expected an <OpenDRIVE> element; found <mujoco>"));
  EXPECT_THAT(WhyNot(Document("")), HasSubstr("a network needs at least one road"));
}

TEST(OpenDrive, RefusesDocumentTypesSoThatNoEntityIsExpanded) {
  const std::string bomb =
      "<?xml version='1.0'?><!DOCTYPE l [<!ENTITY a 'ha'><!ENTITY b '&a;&a;&a;&a;'>]>"
      "<OpenDRIVE>&b;</OpenDRIVE>";
  EXPECT_NE(WhyNot(bomb), "");
  EXPECT_THAT(WhyNot("<!DOCTYPE OpenDRIVE>" + Document(RoadText{}.Xml()).substr(22)),
              HasSubstr("document type declarations"));
}

TEST(OpenDrive, RefusesDeepNestingAndMasses) {
  std::string deep;
  for (int i = 0; i < 100000; ++i) {
    deep += "<a>";
  }
  EXPECT_THAT(WhyNot("<OpenDRIVE>" + deep), HasSubstr("nested too deeply"));
  std::string many = "<OpenDRIVE>";
  for (int i = 0; i < 4000001; ++i) {
    many += "<a/>";
  }
  EXPECT_THAT(WhyNot(many), HasSubstr("more than 4000000 XML tags"));
}

TEST(OpenDrive, ListsTwentyProblemsAndCountsTheOthers) {
  std::string roads;
  for (int i = 0; i < 50; ++i) {
    RoadText road;
    road.id = std::to_string(i);
    road.geometry = "";
    roads += road.Xml();
  }
  const std::string why = WhyNot(Document(roads));
  EXPECT_EQ(std::count(why.begin(), why.end(), '\n'), 20) << why;
}

TEST(OpenDrive, ReadsAHundredThousandRoads) {
  std::string roads;
  for (int i = 0; i < 100000; ++i) {
    roads += "<road id='" + std::to_string(i) +
             "' length='1'><planView><geometry s='0' x='0' y='0' hdg='0' length='1'><line/>"
             "</geometry></planView><lanes><laneSection s='0'><center><lane id='0'/></center>"
             "</laneSection></lanes></road>";
  }
  EXPECT_EQ(ParseNetwork(roads).roads.size(), 100000U);
}

TEST(OpenDrive, KeepsTheTextOfItsFile) {
  const std::string file = ::testing::TempDir() + "open_drive_test.xodr";
  const std::string text = Document(RoadText{}.Xml());
  std::ofstream(file) << text;
  const OpenDriveFile read = ReadOpenDriveFile(file);
  EXPECT_EQ(read.text, text);
  EXPECT_EQ(read.network.roads.size(), 1U);
  EXPECT_THROW(ReadOpenDrive("/no/such/file.xodr"), RunError);
}

}  // namespace
}  // namespace trackbed
