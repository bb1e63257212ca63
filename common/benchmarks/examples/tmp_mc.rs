use benchmarks::baselines::*; use benchmarks::scans::*; use benchmarks::worlds::*; use engine::taper::TaperShape;
fn main(){
  let side: usize = std::env::args().nth(1).unwrap().parse().unwrap();
  for kind in [Kind::Rooms, Kind::Corridors, Kind::Boxes] {
  let p = if kind==Kind::Rooms {0.05} else {0.1};
  let world=World::generate(kind,(side,side),p,1).unwrap(); let space=world.space(360).unwrap();
  let cfg=ScanConfig{beams:180,noise_percent:10.0}; let votes=cfg.votes(TaperShape::Trapezoid);
  for known in [true,false]{
   let mut hits=0; let mut ts=vec![]; let mut eff=vec![];
   let n = if known {10} else if side > 500 {3} else {10};
   for scan in simulate(&world,&space,&cfg,n,3).unwrap(){
    let readings=Readings::new(&scan.scan(),&space,&votes).unwrap();
    let mut mc=MonteCarlo::new(&world,&space,readings.median_sigma_cells(),MonteCarloConfig::default());
    let hs: Vec<usize>= if known {vec![scan.heading]} else {(0..360).collect()};
    let (f,ms)=benchmarks::timing::cpu_ms(||mc.locate(&readings,&hs)); ts.push(ms); eff.push(mc.effort());
    let f=f.unwrap(); let off=f.x.abs_diff(scan.x).max(f.y.abs_diff(scan.y)); let t=(f.heading+360-scan.heading)%360; let t=t.min(360-t);
    if off<=10 && t<=10 {hits+=1}
   }
   ts.sort_by(f64::total_cmp);
   println!("{kind:?} known {known} hits {hits}/{n} median ms {:.1} effort {:?}", ts[ts.len()/2], eff[0]);
  }}
}
