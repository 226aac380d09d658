#include "firmware/supervision/bus_check.hpp"

#include <gtest/gtest.h>

namespace sandhopper {
namespace {

const DetectorMask kAll;

FaultFound see(BusCheck& check, const BusSample& bus) {
  Findings findings(kAll);
  check.see(bus, findings);
  return findings.worst();
}

// Finding of the check after one change of a bus without faults.
template <class Change>
FaultFound changed(Change&& change) {
  BusCheck check;
  BusSample bus;
  EXPECT_EQ(see(check, bus).fault, Fault::none);
  change(bus);
  return see(check, bus);
}

TEST(BusCheck, NamesWhatTheControllerSays) {
  EXPECT_EQ(changed([](auto& b) { b.state = BusState::warning; }).fault, Fault::none);
  EXPECT_EQ(changed([](auto& b) { b.state = BusState::passive; }).fault, Fault::bus_passive);
  EXPECT_EQ(changed([](auto& b) { b.state = BusState::off; }).fault, Fault::bus_off);
  EXPECT_EQ(changed([](auto& b) { b.no_acknowledge = 1; }).fault, Fault::bus_passive);
  EXPECT_EQ(changed([](auto& b) { b.send_failures = 1; }).fault, Fault::bus_send_refused);
  EXPECT_EQ(changed([](auto& b) { b.receive_overflows = 1; }).fault, Fault::bus_overflow);
  EXPECT_EQ(changed([](auto& b) { b.errors = 3; }).fault, Fault::bus_fault);
}

TEST(BusCheck, NamesTheMotorOfAForeignReply) {
  const auto found = changed([](auto& b) { b.rejected[1] = 2; });
  EXPECT_EQ(found.fault, Fault::motor_reply_foreign);
  EXPECT_EQ(found.values[0], 1.0);
  EXPECT_EQ(found.values[1], 2.0);
}

TEST(BusCheck, OfSeveralTheHarshestIsNamed) {
  EXPECT_EQ(changed([](auto& b) {
              b.state = BusState::off;
              b.errors = b.receive_overflows = 5;
            }).fault,
            Fault::bus_off);
}

TEST(BusCheck, WhatWasCountedBeforeTheFirstCycleIsHistory) {
  BusCheck check;
  BusSample bus;
  bus.errors = bus.send_failures = bus.receive_overflows = bus.no_acknowledge = 1000;
  bus.rejected = bus.unsolicited = {7, 7};
  EXPECT_EQ(see(check, bus).fault, Fault::none);
  EXPECT_EQ(see(check, bus).fault, Fault::none);
}

TEST(BusCheck, ACountIsAFaultOnceAndItsOverflowIsNone) {
  BusCheck check;
  BusSample bus;
  bus.errors = UINT32_MAX;
  see(check, bus);
  bus.errors = 0;  // the counter overflows: one more error
  const auto found = see(check, bus);
  EXPECT_EQ(found.fault, Fault::bus_fault);
  EXPECT_EQ(found.values[0], 1.0);
  EXPECT_EQ(see(check, bus).fault, Fault::none);
}

// A late answer is one surplus answer once. A second drive with the same identifier gives one every time.
TEST(BusCheck, OneAnswerTooManyIsNothingFiveAreASecondDrive) {
  BusCheck check;
  BusSample bus;
  see(check, bus);
  for (int i = 0; i < 100; ++i) {
    if (i % 10 == 0) ++bus.unsolicited[0];
    EXPECT_EQ(see(check, bus).fault, Fault::none) << i;
  }
  for (int i = 1; i <= 5; ++i) {
    ++bus.unsolicited[1];
    EXPECT_EQ(see(check, bus).fault, i < 5 ? Fault::none : Fault::motor_reply_unexpected) << i;
  }
}

TEST(BusCheck, AFrameThatTheTransmitGuardRefusedIsAFaultWheneverItWas) {
  BusCheck check;
  BusSample bus;
  bus.refused = {.count = 1, .rule = transmit::Rule::torque, .can_id = 2};
  for (int i = 0; i < 3; ++i) {
    const auto found = see(check, bus);
    EXPECT_EQ(found.fault, Fault::transmit_refused) << "also when it was before the first cycle";
    EXPECT_EQ(found.values[0], static_cast<double>(transmit::Rule::torque));
    EXPECT_EQ(found.values[1], 2.0);
  }
}

}  // namespace
}  // namespace sandhopper
