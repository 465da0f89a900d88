"""A scene for tests of drawing, with a camera for videos and without one."""

SCENE = """
<mujoco>
  <visual><headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/></visual>
  <worldbody>
    <camera name="{camera}" pos="0 0 4" fovy="60"/>
    <body>
      <joint type="slide" axis="1 0 0"/>
      <geom type="box" size=".2 .2 .2" rgba="1 0 0 1"/>
    </body>
    <geom type="box" pos="0 1 0" size=".2 .2 .2" rgba="0 0 1 1"/>
  </worldbody>
</mujoco>
"""
FIXED, FREE = SCENE.format(camera="track"), SCENE.format(camera="other")
