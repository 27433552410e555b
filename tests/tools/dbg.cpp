#include <cstdio>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <visp3/vlp_identification/vpLedDetector.h>
#include <visp3/vlp_core/vpVlpRig.h>
void print(const char*n,const vpStripeFeatures&f){printf("   %s sgn %d f %.1f+-%.1f d %.3f+-%.3f e %.1f misfit %.4f mod %.2f stripes %u\n",n,(int)f.signal,f.frequency,f.frequencySigma,f.duty,f.dutySigma,f.exposure*1e6,f.misfit,f.modulation,f.stripes);}
int main(int argc,char**argv){
  std::string n=argv[1];
  vpVlpRig rig=vpVlpRig::load(n+"-rig.yaml"); vpLampMap map=vpLampMap::load(n+"-lamps.yaml");
  cv::Mat_<unsigned char> m=cv::imread(n+".png",0);
  vpImage<unsigned char> I(m.data,m.rows,m.cols,true);
  vpLedDetector d(rig,map); 
  for(auto&r:d.roiDetector.detect(m)) { printf("roi %d,%d %dx%d level %.1f lampness %.3f cut %d%d\n",r.box.x,r.box.y,r.box.width,r.box.height,r.level,r.lampness,r.cutAcross,r.cutAlong);
   vpLineTiming t=rig.lineTiming();
   vpOutlineFit fit=d.outlineFitter.fit(m,t.linePositions(),t.samplePositions(),r,0);
   vpStripeProfile p=vpStripeProfile::along(m,t,fit,r);
   printf("   shape %d (%.1f %.1f) a %.1f b %.1f blur %.2f agreement %.3f\n",(int)fit.outline.shape,fit.outline.centre.x(),fit.outline.centre.y(),fit.outline.a,fit.outline.b,fit.blur,p.agreement);
   print("along",d.stripeAnalyzer.analyze(p));
   if(argc>2) for(size_t i=0;i<p.light.size();++i) printf("%.0f/%.1f ",p.light[i],p.sigma[i]);
   vpStripeProfile q=vpStripeProfile::agreedByColumns(m,t,fit,r);
   print("agreed",d.stripeAnalyzer.analyze(q));
   if(argc>2) {for(size_t i=0;i<q.light.size();++i) printf("%.0f/%.1f ",q.light[i],q.sigma[i]); printf("\n");}
  }
  d.detect(I);
  for(auto&o:d.observations()){
    printf("obs %s (%.1f,%.1f) shape %d a %.1f b %.1f sig %.2f %.2f blur %.2f other %.2g | %s\n",o.id.c_str(),o.point.x(),o.point.y(),(int)o.outline.shape,o.outline.a,o.outline.b,std::sqrt(o.covariance(0,0)),std::sqrt(o.covariance(1,1)),o.blur,o.outline.otherShape,o.remark.c_str());
    print("",o.features);
  }
}
