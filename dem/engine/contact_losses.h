// What contacts have done with the energy that bodies gave them (energy_balance.h).
#pragma once

namespace grainfield::dem {

/// Where energy has gone in contacts, J.
struct ContactLosses {
  double dashpot =
      0;  ///< normal ones; what a grain that parts faster than its spring follows loses
  double friction = 0;  ///< sliding, and dashpots along the contact
  double rolling = 0;   ///< rolling and twisting
  double law = 0;       ///< work of the law: made, not lost
  double stored = 0;    ///< of grains that were put together: neither

  double lost() const { return dashpot + friction + rolling; }
  ContactLosses& operator+=(const ContactLosses& other) {
    dashpot += other.dashpot;
    friction += other.friction;
    rolling += other.rolling;
    law += other.law;
    stored += other.stored;
    return *this;
  }
};

}  // namespace grainfield::dem
