// Materials of one colour.

fn local_material(number: f32, at: Place, d: vec3f) -> LocalMaterial {
    let m = material_numbered(number);
    let finish = vec4f(m.specular, m.metallic, m.roughness, m.transmission);
    return LocalMaterial(m.albedo, m.emission, finish, m.shininess, at.normal);
}
