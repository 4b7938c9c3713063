use moorline::rod::{line::*, mesh::*, physics, state::State};
use moorline::scene::types::{self, Scene};
use moorline::solve::{newton::*, start, statics, controller::*, motion::Path};
use nalgebra::Vector3;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let text = std::fs::read_to_string("examples/lindahl-sjoberg.json").unwrap();
    let scene: Scene = serde_json::from_str(&text).unwrap();
    let reference: Vec<f64> = std::fs::read_to_string("/work/shared/reference/lindahl_sjoberg_tension.csv").unwrap().lines().skip(1).map(|l| l.split(',').nth(1).unwrap().parse().unwrap()).collect();
    let scheme = match args[1].as_str() { "am" => types::Scheme::AdamsMoulton, "e3" => types::Scheme::Esdirk3, _ => types::Scheme::GeneralizedAlpha };
    let lens: Vec<usize> = args[2].split('+').map(|x| x.parse().unwrap()).collect();
    let lengths: Vec<f64> = if lens.len() == 1 { vec![1200.0 / lens[0] as f64; lens[0]] } else {
        let z = [560.0, 320.0, 320.0]; lens.iter().zip(z).flat_map(|(n, l)| vec![l / *n as f64; *n]).collect() };
    let n = lengths.len();
    let p = Mesh::properties(&scene, &scene.lines[0]);
    let mesh = Mesh::new(p, &[lengths]);
    let around = physics::Surroundings::of(&scene, &mesh);
    let plane = around.ground.as_ref().map(|g| g.plane);
    let s = Supports::pinned(&mesh);
    let line = physics::build(mesh, around, s);
    for arg in &args[3..] {
        let mut m = at_rest(n + 1, 0.0, 0.05);
        start::guess(line.mesh(), &start::Bounds { bed: plane, surface: true }, &Vector3::from(scene.lines[0].anchor), &Vector3::from(scene.lines[0].fairlead), &mut m.state.u);
        let mut newton = Newton::new(line.as_ref());
        let _b = statics::settle(line.as_ref(), &mut newton, &mut m.state);
        newton.forget(); newton.effort = Default::default();
        let path = Path::Sinusoidal { origin: Vector3::zeros(), omega: 2.0 * std::f64::consts::PI / 15.0, sine: Vector3::new(5.08, 2.1, 0.0), cosine: Vector3::zeros(), ramp: 48.75 };
        let fixed = arg.strip_prefix('h').map(|x| x.parse::<f64>().unwrap());
        let rate: f64 = if fixed.is_some() { 1.0 } else { arg.parse().unwrap() };
        let ntol: f64 = std::env::var("NTOL").map(|x| x.parse().unwrap()).unwrap_or(1e-5);
        let demands = Demands { error_rate: rate, max_step: 0.5, fixed_step: fixed, criteria: Criteria { tolerance: ntol, length: 1200.0, iterations: 12 } };
        let mut c = Controller::new(scheme, n + 1);
        let t = std::time::Instant::now();
        let mut f = vec![Vector3::zeros(); n + 1];
        let (mut e2, mut r2, mut em, mut rm) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
        let mut dt = 0.0;
        for k in 1..=1200 {
            let t0 = std::time::Instant::now();
            if let Err(e) = c.advance(line.as_ref(), &mut newton, &path, &demands, &mut m, k as f64 * 0.1, |_| {}) { println!("{e:?}"); break; }
            dt += t0.elapsed().as_secs_f64();
            line.node_forces(&motion(&m.state), &mut f);
            let tension = f[n].norm();
            if k >= 600 { let e = tension - reference[k]; e2 += e * e; r2 += reference[k] * reference[k]; em = em.max(e.abs()); rm = rm.max(reference[k]); }
        }
        let _ = t;
        println!("{} {} {arg}: rms {:.4}% max {:.4}% {:?} {:?} {:.1} ms  {:.1} ns/el-it", args[1], args[2], 100.0 * (e2 / r2).sqrt(), 100.0 * em / rm, c.tally, newton.effort, dt * 1e3, dt * 1e9 / (newton.effort.iterations * n) as f64);
    }
}
