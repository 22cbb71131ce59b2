# %% [markdown]
# # 3 A mechanism of one's own
#
# A twin is a URDF and a short YAML file. Here both are written from Python: a door with a closer
# that is one's own to choose, without a lock. Needs matplotlib.

# %%
import pathlib
import tempfile

import matplotlib.pyplot as plt

import hapticgiant as hg

GATE = """<robot name="gate">
  <link name="base"/>
  <joint name="hinge" type="revolute">
    <parent link="base"/><child link="leaf"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="1.2" velocity="1.2" effort="100"/>
  </joint>
  <link name="leaf"><inertial>
    <origin xyz="0.4 0 0"/><mass value="8"/>
    <inertia ixx="0.5" iyy="0.6" izz="0.6" ixy="0" ixz="0" iyz="0"/>
  </inertial></link>
  <joint name="grip" type="fixed">
    <parent link="leaf"/><child link="handle"/><origin xyz="0.75 0 0" rpy="1.5708 0 0"/>
  </joint>
  <link name="handle"/>
</robot>"""

TWIN = """name: gate
urdf: gate.urdf
end_effector: handle
placement: {{x_m: -0.30, y_m: -0.20, z_m: -0.80}}
joints:
  hinge: {{ddq_max_rad_per_s2: 3, damping_Nms_per_rad: 8, stiffness_Nm_per_rad: {stiffness}}}
"""

PUSH = """frame: twin_joints
hand: {stiffness_N_per_m: [80, 80, 80], damping_Ns_per_m: [11, 11, 11],
       angular_stiffness_Nm_per_rad: [0, 0, 0], angular_damping_Nms_per_rad: [0, 0, 0],
       force_max_N: 35}
start: {grip: 0}
segments:
  - {start_s: 1.0, duration_s: 0.3, fz_N: -12}
  - {start_s: 5.0, duration_s: 0.3, fz_N: 0}
duration_s: 7
"""


def push(stiffness):
    """The gate with this closer, pushed with 12 N for four seconds."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "gate.urdf").write_text(GATE)
        (folder / "twin.yaml").write_text(TWIN.format(stiffness=stiffness))
        (folder / "push.yaml").write_text(PUSH)
        scenario = folder / "gate.yaml"
        scenario.write_text(f"title: Gate\ndescription: A push.\n"
                            f"device: {hg.MODELS}/haptic_giant/device.yaml\n"
                            f"twin: twin.yaml\nperson: push.yaml\nduration_s: 7\n")
        return hg.run(scenario)


# %% [markdown]
# The push of 12 N at 0.75 m is a torque of 9 Nm. A spring of 15 Nm/rad comes to rest at 0.6 rad: what
# is felt through the whole machine is the mechanism in the file.

# %%
runs = {stiffness: push(stiffness) for stiffness in (10, 15, 25)}
for stiffness, run in runs.items():
    time, hinge = run["time_s"], run["twin.q_a"][:, 0]
    rests = hinge[(time > 4.5) & (time < 5.0)].mean()
    print(f"{stiffness} Nm/rad: rests at {rests:.3f} rad, expected {9.0 / stiffness:.3f}")
    assert abs(rests - 9.0 / stiffness) < 0.05

# %%
figure, axes = plt.subplots()
for stiffness, run in runs.items():
    axes.plot(run["time_s"], run["twin.q_a"][:, 0], label=f"{stiffness} Nm/rad")
    axes.axhline(9.0 / stiffness, color="grey", linestyle=":", linewidth=0.8)
axes.set(xlabel="s", ylabel="hinge, rad", title="One push, three closers; dotted: torque over stiffness")
axes.legend()
plt.show()
