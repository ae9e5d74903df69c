# SPDX-License-Identifier: Apache-2.0
"""query_once.py IMAGE: two bodies of one shape, the first just pressed onto the second."""

import sys

import numpy as np

import palpate

body = palpate.Image(sys.argv[1])
engine = palpate.Engine([body, body], engine="regions", delta_m=0.0005, stiffness_N_per_m=600)

# A row for each body: px py pz, then the quaternion w x y z. They touch where they are 16 mm apart.
poses = np.array([[0.002, 0.0, 0.0157, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0, 0]])
result = engine.tick(poses)

print("force on the first body ", np.round(result.force_N, 4), "N")
print("torque about its origin ", np.round(result.torque_Nm, 6), "N m")
print(f"nearest {result.min_distance_m * 1e3:.3f} mm, certain to {result.error_bound_m * 1e3:.3f} mm")
contacts = engine.contacts()
print(f"{len(contacts)} contacts, the nearest ones:")
for contact in contacts[np.argsort(contacts["distance_m"])[:3]]:
    print(f"at {np.round(contact['centre_m'] * 1e3, 2)} mm, normal {np.round(contact['normal'], 3)}")
