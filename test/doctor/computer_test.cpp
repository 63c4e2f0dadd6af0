#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "doctor/examination.hpp"
#include "patient.hpp"
#include "said.hpp"

namespace pmg::doctor {
namespace {

using test::kReserved;
using test::Patient;
using test::said;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

can::BusSetup bus() {
  can::BusSetup setup;
  setup.name = "can0";
  setup.bitrate = 1'000'000;
  return setup;
}

TEST(Doctor, OnAHealthyComputerEveryLineIsOk) {
  const Patient patient;
  ControllerNeeds needs = {.realtime = true,
                           .priority = 80,
                           .cpus = kReserved,
                           .can_buses = {bus()},
                           .cards = {"eth1"},
                           .imu = model::SerialImuModel{.device = "/dev/ttyUSB0", .baud = 921600, .rate_Hz = 400},
                           .log = "out"};
  const Findings findings = examine_for_controller(patient, needs);
  EXPECT_EQ(findings.size(), 23u);
  for (const Finding& finding : findings) {
    EXPECT_EQ(finding.verdict, Verdict::kOk) << to_lines(finding).front();
    EXPECT_EQ(finding.remedy, "") << finding.check;
    EXPECT_EQ(to_lines(finding).size(), 1u);
  }
  EXPECT_EQ(refusal(findings), "");
}

TEST(Doctor, AKernelIsJudgedByItsPreemption) {
  Patient patient;
  EXPECT_EQ(said(check_kernel(patient), "kernel"), "ok: PREEMPT_RT");
  patient.files.erase("sys/kernel/realtime");
  EXPECT_EQ(said(check_kernel(patient), "kernel"), "ok: PREEMPT_RT") << "its version says so";
  patient.files["proc/version"] = "Linux version 6.12 #1 SMP PREEMPT_DYNAMIC";
  EXPECT_THAT(said(check_kernel(patient), "kernel"), StartsWith("warn: its preemption isn't told"));
  patient.files["proc/cmdline"] = "quiet preempt=none";
  EXPECT_THAT(said(check_kernel(patient), "kernel"),
              AllOf(StartsWith("fail: no preemption"), HasSubstr("linux-image-rt-amd64")));
  patient.files["sys/kernel/debug/sched/preempt"] = "none voluntary (full) lazy";
  EXPECT_THAT(said(check_kernel(patient), "kernel"), StartsWith("warn: preemptible, but not PREEMPT_RT"));
  patient.files["sys/kernel/debug/sched/preempt"] = "none (voluntary) full";
  EXPECT_THAT(said(check_kernel(patient), "kernel"),
              AllOf(StartsWith("warn: preemption is voluntary"), HasSubstr("preempt=full")));
  patient.files.erase("sys/kernel/debug/sched/preempt");
  patient.files.erase("proc/cmdline");
  patient.files["proc/version"] = "Linux version 6.12 #1 SMP";
  EXPECT_THAT(said(check_kernel(patient), "kernel"), StartsWith("fail: no preemption"));
}

TEST(Doctor, RealTimePriorityNeedsTheLimitOrTheCapability) {
  const auto line = [](const Patient& patient) {
    return said(check_realtime_rights(patient, 80), "real-time priority");
  };
  Patient patient;
  EXPECT_EQ(line(patient), "ok: SCHED_FIFO with priority 80 is granted");
  patient.files["proc/self/limits"] = "Max realtime priority     79                   90\n";
  EXPECT_THAT(line(patient), AllOf(StartsWith("fail: RLIMIT_RTPRIO is 79 and CAP_SYS_NICE is missing; expected 80"),
                                   HasSubstr("`USER - rtprio 90`")));
  patient.files["proc/self/status"] = "CapEff:\t0000000000800000\n";
  EXPECT_THAT(line(patient), StartsWith("ok")) << "CAP_SYS_NICE is bit 23";
  patient.fifo_error = EPERM;
  EXPECT_THAT(line(patient), StartsWith("fail: SCHED_FIFO with priority 80 is refused: Operation not permitted"));
}

TEST(Doctor, MemoryMustBeLockable) {
  const auto line = [](const Patient& patient) { return said(check_realtime_rights(patient, 80), "locked memory"); };
  Patient patient;
  EXPECT_THAT(line(patient), StartsWith("ok"));
  patient.files["proc/self/limits"] = "Max locked memory         8388608              8388608              bytes\n";
  EXPECT_THAT(line(patient),
              AllOf(StartsWith("fail: RLIMIT_MEMLOCK is 8192 kB"), HasSubstr("`USER - memlock unlimited`")));
  patient.files["proc/self/status"] = "CapEff:\t0000000000004000\n";
  EXPECT_THAT(line(patient), StartsWith("ok")) << "CAP_IPC_LOCK is bit 14";
  patient.files.erase("proc/self/status");
  patient.files.erase("proc/self/limits");
  EXPECT_THAT(line(patient), StartsWith("fail")) << "what isn't known isn't granted";
}

TEST(Doctor, RealTimeThreadsNeedTheirShareOfACpu) {
  const auto line = [](const Patient& patient) {
    return said(check_realtime_rights(patient, 80), "real-time throttling");
  };
  Patient patient;
  EXPECT_EQ(line(patient), "ok: real-time threads may have 95 % of a CPU");
  std::string& runtime_us = patient.files["proc/sys/kernel/sched_rt_runtime_us"];
  runtime_us = "-1";
  EXPECT_EQ(line(patient), "ok: real-time threads may have 100 % of a CPU");
  runtime_us = "500000";
  EXPECT_THAT(line(patient), AllOf(StartsWith("warn: real-time threads may have 50 %"), HasSubstr("sysctl -w")));
  runtime_us = "0";
  EXPECT_THAT(line(patient), StartsWith("fail: kernel.sched_rt_runtime_us is 0"));
}

TEST(Doctor, TheReservedCpusAreThereIsolatedAndQuiet) {
  const auto line = [](const Patient& patient, RealtimeCpus cpus) {
    return said(check_cpus(patient, cpus), "isolated CPUs");
  };
  Patient patient;
  EXPECT_EQ(line(patient, kReserved), "ok: 2, 3 for the real-time threads alone");
  EXPECT_THAT(line(patient, {.bus = 2, .control = 7}),
              StartsWith("fail: CPU 7 is asked for; this computer has 0, 1, 2, 3"));
  EXPECT_THAT(line(patient, {}), AllOf(StartsWith("warn: 2, 3 isolated, and nothing runs there"),
                                       HasSubstr("--bus-cpu 2 --control-cpu 3")));
  EXPECT_THAT(line(patient, {.bus = 1, .control = 2}), StartsWith("warn: CPU 1 is shared"));
  EXPECT_THAT(line(patient, {.bus = 2, .control = 2}), StartsWith("warn: bus and control thread share CPU 2"));
  patient.files["sys/devices/system/cpu/nohz_full"] = "2";
  EXPECT_THAT(line(patient, kReserved),
              AllOf(StartsWith("warn: CPU 3 is isolated, and the scheduler's clock"), HasSubstr("nohz_full=2,3")));
  patient.files["sys/devices/system/cpu/isolated"] = "";
  EXPECT_THAT(line(patient, kReserved), AllOf(StartsWith("warn: none"), HasSubstr("isolcpus=2,3")));
}

TEST(Doctor, AGovernorThatKeepsTheLowestFrequencyFails) {
  const auto line = [](const Patient& patient) { return said(check_cpus(patient, kReserved), "CPU frequency"); };
  Patient patient;
  EXPECT_THAT(line(patient), StartsWith("ok: governor performance"));
  std::string& governor = patient.files["sys/devices/system/cpu/cpu3/cpufreq/scaling_governor"];
  governor = "schedutil";
  EXPECT_THAT(line(patient), AllOf(StartsWith("warn: governor schedutil on CPU 3"), HasSubstr("echo performance")));
  governor = "powersave";
  EXPECT_THAT(line(patient), StartsWith("fail: governor powersave on CPU 3"));
  patient.files["sys/devices/system/cpu/cpu3/cpufreq/scaling_driver"] = "intel_pstate";
  EXPECT_THAT(line(patient), StartsWith("warn")) << "there it follows the load";
}

TEST(Doctor, OtherDevicesInterruptOtherCpus) {
  const auto line = [](const Patient& patient) {
    return said(check_cpus(patient, kReserved), "interrupts of other devices");
  };
  Patient patient;
  EXPECT_EQ(line(patient), "ok: none on CPU 2, 3");
  patient.files["proc/irq/24/effective_affinity_list"] = "";
  patient.files["proc/irq/24/smp_affinity_list"] = "0-3";
  EXPECT_THAT(line(patient), AllOf(StartsWith("warn: 1 on CPU 2, 3: ahci (24)"), HasSubstr("irqbalance")));
}

TEST(Doctor, ClocksAreSteadySetAndDontJump) {
  Patient patient;
  const ClockReading began = patient.now;
  const auto line = [&](const char* check) { return said(check_clock(patient, began, patient.now, {}), check); };
  std::string& source = patient.files["sys/devices/system/clocksource/clocksource0/current_clocksource"];
  EXPECT_EQ(line("clock source"), "ok: tsc");
  source = "hpet";
  EXPECT_THAT(line("clock source"), StartsWith("warn: hpet"));
  source = "jiffies";
  EXPECT_THAT(line("clock source"), StartsWith("fail: jiffies"));
  EXPECT_EQ(line("clock set"), "ok: synchronised");
  patient.now.synchronised = false;
  EXPECT_THAT(line("clock set"),
              AllOf(StartsWith("warn: nothing synchronises it"), HasSubstr("timedatectl set-ntp true")));
  patient.now.realtime_ns = 86'400'000'000'000;
  EXPECT_THAT(line("clock set"), StartsWith("fail: it is the year 1970"));
  patient.now = {.realtime_ns = began.realtime_ns + 1'009'000'000, .monotonic_ns = began.monotonic_ns + 1'000'000'000};
  EXPECT_THAT(line("clock jumps"), StartsWith("ok"));
  patient.now.realtime_ns = began.realtime_ns + 989'000'000;
  EXPECT_THAT(line("clock jumps"), StartsWith("fail: it jumped by -0.011 s"));
}

TEST(Doctor, TheDiskHasRoomAndIsFastEnough) {
  Patient patient;
  const auto line = [&](const char* check) { return said(check_disk(patient, "out", {}), check); };
  EXPECT_EQ(line("disk space"), "ok: 107374 MB free in /data");
  patient.space.free_bytes = std::uint64_t{1} << 30;
  EXPECT_THAT(line("disk space"), StartsWith("warn: 1074 MB free in /data; a full log folder has 2449 MB"));
  patient.space.free_bytes = std::uint64_t{300} << 20;
  EXPECT_THAT(line("disk space"), AllOf(StartsWith("fail: 315 MB free"), HasSubstr("a log needs 336 MB")));
  EXPECT_EQ(line("disk speed"), "ok: 100.0 MB/s");
  patient.speed.bytes_per_s = 5e6;
  EXPECT_THAT(line("disk speed"), StartsWith("warn: 5.0 MB/s"));
  patient.speed.bytes_per_s = 0.8e6;
  EXPECT_THAT(line("disk speed"), StartsWith("fail: 0.8 MB/s; a log needs 0.9 MB/s"));
  patient.speed.problem = "Read-only file system";
  EXPECT_THAT(line("disk speed"), StartsWith("fail: /data can't be written: Read-only file system"));
}

TEST(Doctor, WhatDoesNotConcernAControllerIsNotAsked) {
  const Patient patient;
  const Findings findings = examine_for_controller(
      patient, {.realtime = false, .cpus = {}, .can_buses = {}, .cards = {}, .imu = {}, .log = {}});
  EXPECT_EQ(findings.size(), 3u) << "the clocks";
}

TEST(Doctor, ARefusalNamesTheFirstFailureAndCountsTheOthers) {
  const Findings findings = {ok("a", "good"), warn("b", "so so", "do"), fail("can0", "is down", "ip link"),
                             fail("can1", "is down", "ip link")};
  EXPECT_EQ(refusal(findings), "can0: is down; ip link (1 more: pmg_doctor)");
  EXPECT_EQ(to_lines(findings[2]), (std::vector<std::string>{"fail  can0: is down", "      -> ip link"}));
}

}  // namespace
}  // namespace pmg::doctor
