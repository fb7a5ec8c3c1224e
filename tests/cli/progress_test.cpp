// The progress line, on a pseudo-terminal.
#include <csignal>
#include <cstdlib>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "cli/program.h"
#include "support/shared.h"

namespace raygrain::test {
namespace {

constexpr char kErase[] = "\r\033[K";

/// What a program that runs with it as standard error shows there.
class Terminal {
 public:
  Terminal() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
    if (::grantpt(master_) == 0 && ::unlockpt(master_) == 0) name_ = ::ptsname(master_);
    slave_ = ::open(name_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);  // else what is written is lost with the program
  }
  ~Terminal() {
    ::close(slave_);
    ::close(master_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  const std::string& name() const { return name_; }
  const std::string& read() {
    char bytes[4096];
    for (ssize_t count = 0; (count = ::read(master_, bytes, sizeof bytes)) > 0;)
      text_.append(bytes, static_cast<size_t>(count));
    return text_;
  }
  /// Until `part` is there or the program ends.
  bool wait_for(const std::string& part, RunningProgram& program) {
    while (read().find(part) == std::string::npos) {
      if (!program.is_running()) return read().find(part) != std::string::npos;
      ::usleep(20'000);
    }
    return true;
  }

 private:
  int master_, slave_ = -1;
  std::string name_, text_;
};

class ProgressLine : public testing::Test {
 protected:
  RunningProgram start(const std::vector<std::string>& arguments) {
    return {arguments, folder_.file("out"), terminal_.name(), {}};
  }
  TemporaryFolder folder_;
  Terminal terminal_;
};

TEST_F(ProgressLine, TellsPartsOfTheBruteForceOfTrace) {
  std::string rays = "ox,oy,oz,dx,dy,dz\n";
  for (int i = 0; i < 300'000; ++i) rays += "0,90,0,0,-1,0\n";
  write_file(folder_.file("rays.csv"), rays);
  RunningProgram program = start({"trace", "procedural:city?size=20", "--rays", folder_.file("rays.csv"), "-o",
                                  folder_.file("hits.csv"), "--verify", "--threads", "1"});
  EXPECT_TRUE(terminal_.wait_for("search by brute force", program)) << terminal_.read();
  program.send(SIGINT);
  EXPECT_EQ(program.wait(), 130);
  EXPECT_TRUE(terminal_.read().ends_with(kErase)) << "leftovers: " << terminal_.read();
}

TEST_F(ProgressLine, ShowsAStepOfCompareThatBeganEarly) {
  RunningProgram program = start({"compare", "procedural:city?size=20", "--recipes", "SAH+LSPH@binned", "--rays",
                                  "300000", "--verify", "--threads", "1"});
  EXPECT_TRUE(terminal_.wait_for("sun: search by brute force", program)) << terminal_.read();
  program.send(SIGTERM);
  EXPECT_EQ(program.wait(), 143);
  EXPECT_TRUE(terminal_.read().ends_with(kErase)) << "leftovers: " << terminal_.read();
}

TEST_F(ProgressLine, AnInterruptedVerificationEndsWithItsVerdict) {
  RunningProgram program = start({"verify", "--minutes", "60", "--threads", "1", "--out", folder_.file("failures")});
  EXPECT_TRUE(terminal_.wait_for(" M/s", program)) << terminal_.read();  // the end of a line of 80 columns
  EXPECT_NE(terminal_.read().find(" %  0 differences, "), std::string::npos) << terminal_.read();
  program.send(SIGINT);
  EXPECT_EQ(program.wait(), 0);
  EXPECT_TRUE(terminal_.read().ends_with(kErase)) << "leftovers: " << terminal_.read();
  const std::string output = read_file(folder_.file("out"));
  EXPECT_TRUE(output.starts_with("verified: ")) << output;
  EXPECT_NE(output.find(" 0 differences, 0 leaks"), std::string::npos) << output;
  EXPECT_TRUE(names_in(folder_.file("failures")).empty());
}

/// The terminal of this test has 80 columns, less than the longest names of rows.
TEST_F(ProgressLine, TellsTheTimeLeftOfAStudyBeforeLongNames) {
  RunningProgram program =
      start({"study", "parameters", "--only", "Random1000", "--rays", "20000", "--out", folder_.file("study")});
  EXPECT_TRUE(terminal_.wait_for(" left, Random1000 p", program)) << terminal_.read();
  program.send(SIGINT);
  EXPECT_EQ(program.wait(), 130);
}

// Takes seconds.
const std::vector<std::string> kCompare{
    "compare", "procedural:city?size=30", "--recipes", "SAH+LSPH", "--rays", "5000", "--threads", "1"};

TEST_F(ProgressLine, IsErasedAtTheEnd) {
  RunningProgram program = start(kCompare);
  EXPECT_EQ(program.wait(), 0);
  const std::string text = terminal_.read();
  EXPECT_NE(text.find("] "), std::string::npos) << "the scene is too small for this test";
  EXPECT_TRUE(text.ends_with(kErase)) << text;
}

TEST_F(ProgressLine, IsNotShownWhenQuiet) {
  std::vector<std::string> arguments = kCompare;
  arguments.push_back("--quiet");
  RunningProgram program = start(arguments);
  EXPECT_EQ(program.wait(), 0);
  EXPECT_EQ(terminal_.read(), "");
}

}  // namespace
}  // namespace raygrain::test
