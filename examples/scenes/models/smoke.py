# Makes smoke.npy, the puff of smoke in ../smoke.toml: a plume that rises, widens and bends, as
# array[x, y, z] of float32 between 0 and 1.
import numpy as np

nx, ny, nz = 25, 25, 41
x, y, z = np.meshgrid(np.linspace(-1, 1, nx), np.linspace(-1, 1, ny), np.linspace(0, 1, nz), indexing="ij")
bend_x, bend_y = 0.35 * np.sin(3.0 * z), 0.25 * z * np.cos(5.0 * z)      # its axis
radius = 0.10 + 0.42 * z                                                 # its width
billows = 1.0 + 0.35 * np.sin(9.0 * x + 4.0 * z) * np.sin(8.0 * y - 11.0 * z)
r2 = ((x - bend_x) ** 2 + (y - bend_y) ** 2) / radius**2
smoke = np.exp(-1.6 * r2) * billows * (0.12 / radius) * np.clip((1.0 - z) / 0.2, 0, 1)
smoke *= np.clip((1.0 - np.maximum(abs(x), abs(y))) / 0.2, 0, 1)        # 0 on the box's faces
np.save("smoke.npy", (smoke / smoke.max()).astype(np.float32))
