# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The energy balance of a run: what the drive and the load put in, what friction and dampers took, what is stored."""

from typing import NamedTuple


class EnergyBalance(NamedTuple):
    """Energies from the start of a run to the present time, all in J.

    The works are integrals over the motion and the stored energies are read off the state, so that what is left over
    shows how well the motion obeys m ẍ = F_d + F_e − F.

        drive_work + external_work + contact_exchange + parameter_exchange
            = friction_loss + drive_damper_loss + contact_damper_loss + (stored − stored_at_start) + residual
    """

    drive_work: float           # ∫ F_d v dt, done by the drive at its end of spring and damper
    external_work: float        # ∫ F_e ẋ dt, done by the external force on the slider
    friction_loss: float        # ∫ F_f ẋ dt over the slips, ∫ F_f z′ dt over the yields
    drive_damper_loss: float    # ∫ h (v − ẋ)² dt
    contact_damper_loss: float  # ∫ h_c δ′² dt over the sticks (δ′ = ẋ) and yields of a compliant contact
    contact_exchange: float     # c_c δ²/2 that appears at arrests, less what vanishes at break-aways
    parameter_exchange: float   # change of the stored energy at a change of parameters
    stored: float               # m ẋ²/2 + c (s − x)²/2 + c_c δ²/2 now
    stored_at_start: float
    throughput: float           # sum of the magnitudes of all works and exchanges, event by event

    @property
    def residual(self) -> float:
        """What the balance leaves unexplained, J."""
        given = self.drive_work + self.external_work + self.contact_exchange + self.parameter_exchange
        taken = self.friction_loss + self.drive_damper_loss + self.contact_damper_loss
        return (given - taken) - (self.stored - self.stored_at_start)

    @property
    def relative_residual(self) -> float:
        """|residual| over the throughput, or over the stored energy where that is larger; 0 where nothing happened."""
        scale = max(self.throughput, self.stored, self.stored_at_start)
        return abs(self.residual) / scale if scale > 0.0 else 0.0
