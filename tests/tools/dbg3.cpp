#include <cstdio>
#include "real/realSet.h"
#include <visp3/vlp_identification/vpLedDetector.h>
int main(int argc,char**argv){
  RealSet set("lumia-floor-2"); const YAML::Node image=set.images()[0];
  vpVlpFrame f=set.frame(image); vpVlpRig rig=set.rig(image,f,10e-6); vpLampMap map=set.map();
  vpLinePicture p(f.I,rig.shutter.alongColumns()); vpLineTiming t=rig.lineTiming();
  vpLedRoi r; r.box=cv::Rect(899,780,137,150); if(argc>4) r.box=cv::Rect(atoi(argv[1]),atoi(argv[2]),atoi(argv[3]),atoi(argv[4]));
  auto q=vpStripeProfile::agreedByColumns(p.grey,t,vpOutlineFitter::boxOf(r),r);
  for(size_t i=0;i<q.light.size();++i) printf("%.0f/%.1f ",q.light[i],q.sigma[i]); printf("\n");
  for(int y=r.box.y;y<r.box.br().y;y+=2){ for(int x=r.box.x;x<r.box.br().x;x+=6) printf("%3d ",p.grey(y,x)); printf("\n"); }
}
