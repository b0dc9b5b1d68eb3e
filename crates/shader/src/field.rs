//! Stands for the field until its recorded form is here: to be replaced whole by the folder `field/`.
use zeroset_field::program::Structure;
pub(crate) struct FieldSource {
    pub(crate) text: String,
    pub(crate) code: Vec<u32>,
}
impl FieldSource {
    pub(crate) fn compiled(_s: &Structure) -> Self {
        Self {
            text: "struct Marks { object: f32, first: f32, second: f32, share: f32, orbit: vec4f }
fn field(p: vec3f) -> f32 { return length(p) - params[0]; }
fn field_gradient(p: vec3f) -> vec4f { return vec4f(field(p), p); }
fn field_marks(p: vec3f) -> Marks { return Marks(0.0,0.0,-1.0,0.0,vec4f(0.0)); }
"
            .into(),
            code: vec![0],
        }
    }
    pub(crate) fn interpreted(s: &Structure) -> Self {
        Self::compiled(s)
    }
}
