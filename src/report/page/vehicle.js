// Creates the vehicle of the 3D scene. The vehicle's shape comes from the run's model; its pose is
// computed from the state log by forward kinematics of the joints.

const GHOST = 0.42;  // opacity of a ghost, the translucent car of another plant

/** Decodes a channel, which is base64 of float32, or of int16 with offset and scale. */
function numbersOf(channel) {
  const bytes = Uint8Array.from(atob(channel.f4 || channel.i2), (c) => c.charCodeAt(0));
  if (channel.f4) return new Float32Array(bytes.buffer);
  return Float64Array.from(new Int16Array(bytes.buffer), (steps) => channel.offset + channel.scale * steps);
}

/** Returns the motion of a track: the times, and the channels by name. */
function motionOf(track) {
  const { motion } = runs[track.run].plants.find((plant) => plant.name === track.plant);
  // The channels grow while a run is in progress, so they must be ordinary arrays.
  const numbers = (channel) => (data.live ? Array.from(numbersOf(channel)) : numbersOf(channel));
  const channels = Object.fromEntries(Object.entries(motion.channels).map(([name, channel]) => [name, numbers(channel)]));
  return { t: numbers(motion.t), channels };
}

/** Converts a quaternion (w, x, y, z) of MuJoCo to three.js. */
function quaternionOf([w, x, y, z]) {
  return new THREE.Quaternion(x, y, z, w);
}

function shapeOf(geom, meshes) {
  const [a, b, c] = geom.size;
  switch (geom.type) {
    case 'sphere': return new THREE.SphereBufferGeometry(a, 20, 14);
    case 'ellipsoid': return new THREE.SphereBufferGeometry(1, 20, 14).scale(a, b, c);
    case 'cylinder': return new THREE.CylinderBufferGeometry(a, a, 2 * b, 36).rotateX(Math.PI / 2);
    case 'capsule': return new THREE.CylinderBufferGeometry(a, a, 2 * (b + a), 24).rotateX(Math.PI / 2);
    case 'box': return new THREE.BoxBufferGeometry(2 * a, 2 * b, 2 * c);
    default: return meshes[geom.mesh];
  }
}

/**
 * Returns the body color of a vehicle, which is the most frequent color of its meshes or, without
 * meshes, of its shapes.
 */
function paintOf({ geoms }) {
  const meshes = geoms.filter(({ type }) => type === 'mesh');
  const counts = d3.nest().key(({ rgba }) => rgba.join()).rollup((list) => list.length).entries(meshes.length ? meshes : geoms);
  return counts.sort((a, b) => b.value - a.value).map(({ key }) => key)[0];
}

/**
 * Returns a function that makes a vehicle. The vehicle has a `group` with its shapes, the `nodes`
 * of its bodies, and the function `pose(motion, time)`, which moves it. All vehicles of a run share
 * the shapes. The vehicle's body has the given color; a ghost is translucent and has this color
 * everywhere.
 */
function vehicleMaker(model) {
  const meshes = model.meshes.map(({ vertices, faces }) => {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(vertices), 3));
    geometry.setIndex(faces);
    const flat = geometry.toNonIndexed();
    flat.computeVertexNormals();
    return flat;
  });
  const shapes = model.geoms.map((geom) => shapeOf(geom, meshes));
  const paint = paintOf(model);

  return ({ color, ghost }) => {
    const group = new THREE.Group();
    const bodies = model.bodies.map((body) => {
      const node = new THREE.Group();
      node.matrixAutoUpdate = false;
      group.add(node);
      return { ...body, node, position: new THREE.Vector3(...body.pos), rotation: quaternionOf(body.quat) };
    });
    const materials = [];
    model.geoms.forEach((geom, i) => {
      const [r, g, b, a] = geom.rgba;
      const material = new THREE.MeshLambertMaterial({
        color: ghost || geom.rgba.join() === paint ? new THREE.Color(color) : new THREE.Color(r, g, b),
        transparent: ghost || a < 1, opacity: ghost ? GHOST : a, depthWrite: true,
        // Draws the ghost farther away, so that a solid car at the same place hides the ghost.
        polygonOffset: ghost, polygonOffsetFactor: 4, polygonOffsetUnits: 40,
      });
      materials.push(material);
      const mesh = new THREE.Mesh(shapes[i], material);
      mesh.position.set(...geom.pos);
      mesh.quaternion.copy(quaternionOf(geom.quat));
      mesh.castShadow = !ghost;
      mesh.receiveShadow = false;
      bodies[geom.body].node.add(mesh);
    });

    const one = new THREE.Vector3(1, 1, 1);
    function pose(motion, time) {
      const { t, channels } = motion;
      const next = Math.min(Math.max(d3.bisectRight(t, time), 1), t.length - 1);
      const part = t.length > 1 ? Math.min(Math.max((time - t[next - 1]) / (t[next] - t[next - 1]), 0), 1) : 0;
      const at = (name) => {
        const values = channels[name];
        if (!values) return 0;
        return t.length > 1 ? values[next - 1] + part * (values[next] - values[next - 1]) : values[0];
      };
      const quaternionAt = (row) => quaternionOf(['qw', 'qx', 'qy', 'qz'].map((name) => channels[name][row]));
      for (const body of bodies) {
        const position = body.position.clone();
        const rotation = body.rotation.clone();
        for (const joint of body.joints) {
          if (joint.type === 'free') {
            position.set(at('x_m'), at('y_m'), at('z_m'));
            rotation.copy(t.length > 1 ? quaternionAt(next - 1).slerp(quaternionAt(next), part) : quaternionAt(0));
          } else if (joint.type === 'slide') {
            position.add(new THREE.Vector3(...joint.axis).multiplyScalar(at(joint.channel)).applyQuaternion(rotation));
          } else {
            // The joint rotates the body about the joint's anchor, which stays fixed.
            const anchor = new THREE.Vector3(...joint.pos);
            const turn = new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(...joint.axis).normalize(), at(joint.channel));
            const before = anchor.clone().applyQuaternion(rotation);
            rotation.multiply(turn);
            position.add(before.sub(anchor.applyQuaternion(rotation)));
          }
        }
        body.node.matrix.compose(position, rotation, one);
        if (body.parent >= 0) body.node.matrix.premultiply(bodies[body.parent].node.matrix);
        body.node.matrixWorldNeedsUpdate = true;
      }
    }
    /**
     * Fades a ghost out near the solid car, which the ghost would only blur. Returns whether the
     * ghost is visible at the distance `apart` from the car [m].
     */
    function fade(apart) {
      const [from, to] = [0.05, 0.3];
      const share = Math.min(1, Math.max(0, (apart - from) / (to - from)));
      for (const material of materials) material.opacity = GHOST * share;
      return share > 0;
    }
    return { group, pose, fade, root: bodies[0].node, nodes: bodies.map(({ node }) => node) };
  };
}
